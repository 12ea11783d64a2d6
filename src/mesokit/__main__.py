"""`python -m mesokit` is `mesokit`."""

from mesokit.cli import main

if __name__ == "__main__":
    main()
