"""Trial of a car in a web page: numbers and script with which the page runs the car for other settings."""
