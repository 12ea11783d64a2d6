"""Parts that both methods of spheres share: disks in 2D and spheres in 3D."""
