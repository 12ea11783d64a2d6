"""Flocks: birds that fly as the others around them do (Vicsek et al. 1995)."""
