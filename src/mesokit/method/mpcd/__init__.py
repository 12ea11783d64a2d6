"""Multi-particle collision dynamics: what makes an MPCD fluid."""
