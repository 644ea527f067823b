"""All published results of the three sources beside ours: one table, one page."""
