"""Lumped models: the quarter-car family, and the machinery that solves any network of masses and elements."""
