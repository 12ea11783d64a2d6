"""Spheres and disks: hard ones, event by event, and soft ones, by forces."""
