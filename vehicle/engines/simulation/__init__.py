"""Static trim, callbacks, the stepping loop, and the matrices of the same model."""
