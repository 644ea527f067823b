"""Generation of the MuJoCo model from parameters and superelement; the only package that creates MJCF elements."""
