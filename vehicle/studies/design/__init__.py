"""Design of a new car from a template car and numbers that every engineer knows: masses, lengths, frequencies."""
