"""What happens to a drawing afterwards: legend, several in one plot, where it comes from, file."""
