"""What compiled loops of any method need: threads, cells, memory in strips, a clock."""
