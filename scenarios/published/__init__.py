"""All published results of the thesis and the two papers with our values: one table, one page."""
