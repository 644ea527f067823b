"""Where body models come from: finite-element matrices, computed modes, modal tests."""

METHODS = ("free-free", "rubin", "craig-bampton")
"""How matrices become modes: those of the free body, the others static; the same with modes that the attachments add;
modes of the body held at the attachments, with constraint modes."""

LENGTHS = {"m": 1.0, "mm": 1e-3, "in": 0.0254}
"""Unit of length to its size [m]."""

MASSES = {"kg": 1.0, "t": 1000.0, "g": 1e-3, "lb": 0.45359237, "lbf s2/in": 175.126835}
"""Unit of mass to its size [kg]."""

FOLLOWING = {"m": "kg", "mm": "t", "in": "lbf s2/in"}
"""Unit of mass that follows from the unit of length."""
