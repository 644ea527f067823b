"""A car that leaves the house: as an FMU, as a web page that runs it, on a bench with sliders."""
