"""What several observables of fluids need."""
