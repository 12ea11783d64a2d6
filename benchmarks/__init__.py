"""Speed of mesokit, by itself and side by side with LAMMPS: `make bench`."""
