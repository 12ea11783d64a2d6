"""Models: what may happen at a site, and at what rate. One file each."""
