"""Rigid disks and spheres with friction, by contact dynamics."""
