"""The tests, a package: they import what they share from `tests.helpers`."""
