"""Where body models come from: finite-element matrices, computed modes, modal tests."""
