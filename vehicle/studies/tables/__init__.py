"""Tables of cars: names, values and units of points, masses and rates in any layout."""
