"""The loops of soft spheres. All bodies lie in three dimensions; disks have z = 0."""
