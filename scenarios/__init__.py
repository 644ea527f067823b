"""Short studies, one script each: `python -m scenarios.NAME`."""
