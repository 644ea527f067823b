"""Measured beside simulated: frequency responses, time histories, mode shapes."""
