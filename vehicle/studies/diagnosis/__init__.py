"""Diagnosis of a driven car from a record: worn dampers with their probabilities."""
