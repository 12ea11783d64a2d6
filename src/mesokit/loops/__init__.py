"""The needs of compiled loops of any method: threads, cells, memory in strips, a clock."""
