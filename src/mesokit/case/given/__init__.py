"""What a run is given to start from: arrays in files, and positions that the box has not."""
