"""Sweeps: many runs of a car on any executor, tables of values, and global sensitivity indices."""
