"""What cells must know of those next to them."""
