"""A car for other programs: as an FMU, as a web page that runs it, on a bench with sliders."""
