"""What methods, engines and observables answer, and what a result is."""
