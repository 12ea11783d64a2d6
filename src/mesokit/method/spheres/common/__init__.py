"""What methods of spheres share: disks in 2D and spheres in 3D, with their sizes and masses."""
