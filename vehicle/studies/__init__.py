"""Studies: each one function that takes a car and an input and writes results."""
