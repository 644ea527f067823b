"""Catalogue of ride figures: definition, unit, histories and value on runs of one or many cars."""
