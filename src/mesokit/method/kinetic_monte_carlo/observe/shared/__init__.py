"""What several observables of lattices have in common."""
