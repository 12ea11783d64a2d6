"""What a sweep is to do."""

COLLIDE, STREAM, MEASURE_STRESS, MEASURE_WALLS = 1, 2, 4, 8
