"""Where body models come from: finite-element matrices, computed modes, modal tests."""

METHODS = ("free-free", "rubin", "craig-bampton")
"""How matrices become modes: those of the free body, the others static; the same with modes that the attachments add;
modes of the body held at the attachments, with constraint modes."""
