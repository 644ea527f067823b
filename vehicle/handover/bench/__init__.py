"""Bench: a web page on which the numbers of a car follow its sliders."""
