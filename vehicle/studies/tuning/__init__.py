"""Fitting parameters of the car to measured FRFs and time histories."""
