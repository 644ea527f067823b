"""How the objects of a car look in a notebook, and their values as tables of other libraries."""
