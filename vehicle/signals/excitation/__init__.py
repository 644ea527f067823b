"""Plate excitation from files and generators, as `vehicle.signals.excitation.signal.Signal`."""
