"""What happens to a drawing afterwards: several in one plot, where it comes from, its file."""
