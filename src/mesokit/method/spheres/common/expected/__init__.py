"""What theory expects of spheres, whatever method moves them."""
