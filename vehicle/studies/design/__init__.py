"""Design of a new car from a template car and stated masses, lengths and frequencies."""
