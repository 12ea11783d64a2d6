"""Rigid bodies that move in the fluid: their motion, hits of particles, virtual particles."""
