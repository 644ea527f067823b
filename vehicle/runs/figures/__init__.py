"""The catalogue of ride figures: what each is, what it needs, and its value on runs of one or many cars."""
