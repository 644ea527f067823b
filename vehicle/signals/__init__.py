"""Signals in files and in memory: measurements, plate and road inputs, spectra, FRFs, comfort; no car."""
