"""The compiled machinery: spheres in memory, neighbour lists, the queue of events, collisions."""
