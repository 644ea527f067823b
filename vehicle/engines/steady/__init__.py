"""The steady engine: the periodic state of a car with all its laws, without a start-up, by operator splitting."""
