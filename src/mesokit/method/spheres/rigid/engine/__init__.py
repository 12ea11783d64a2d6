"""The engine of rigid grains: contacts, their order, sweeps, and the step."""
