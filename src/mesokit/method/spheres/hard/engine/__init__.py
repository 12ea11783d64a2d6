"""The compiled machinery: spheres in memory, who is near whom, what comes next and happens."""
