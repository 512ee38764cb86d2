"""The computations of the studies: each runs coarsely or in full, and returns a `Result`."""
