"""Plots, films, and the objects of a car in a notebook."""
