"""Tables of cars as people have them: names, values and units of points, masses and rates, from files of any layout."""
