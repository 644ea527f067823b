"""Measurement files: formats, units, tables and records, read and written here only."""
