"""Sources of body models: finite-element matrices, computed modes, modal tests."""

METHODS = ("free-free", "rubin", "craig-bampton")
"""Reduction methods: free-free modes with static residual flexibility; free-free modes with attachment modes (Rubin);
modes of the body fixed at the attachments with constraint modes (Craig-Bampton)."""

LENGTHS = {"m": 1.0, "mm": 1e-3, "in": 0.0254}
"""Unit of length -> its size [m]."""

MASSES = {"kg": 1.0, "t": 1000.0, "g": 1e-3, "lb": 0.45359237, "lbf s2/in": 175.126835}
"""Unit of mass -> its size [kg]."""

FOLLOWING = {"m": "kg", "mm": "t", "in": "lbf s2/in"}
"""Unit of length -> consistent unit of mass."""
