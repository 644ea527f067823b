"""Plots and films of a recording: what was simulated is replayed, never stepped."""
