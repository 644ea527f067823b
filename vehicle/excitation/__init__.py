"""Plate excitation: signal files and generated signals, always a `vehicle.excitation.signal.Signal`."""
