"""Comparison of a measurement with a simulation: frequency responses, time histories, mode shapes."""
