"""Signals of the sources: random roads with given RMS, bumps, the drives of four plates."""
