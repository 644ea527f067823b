"""Display of cars and runs in a notebook, and conversion of their values to tables of other libraries."""
