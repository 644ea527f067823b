"""Spectra, FRF, coherence, peaks, slip share and comfort: arrays in, numbers out."""
