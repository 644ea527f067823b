"""A complete car on a shaker, on MuJoCo."""
