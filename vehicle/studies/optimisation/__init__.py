"""Search for the parameters of a car with the best compromise of comfort, tyre load, travel and slip."""
