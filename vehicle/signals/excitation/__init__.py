"""Plate excitation: signal files and generated signals, always a `vehicle.signals.excitation.signal.Signal`."""
