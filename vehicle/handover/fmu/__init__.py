"""A car as an FMU: a file for co-simulation in other simulators, FMI 2.0 or 3.0."""
