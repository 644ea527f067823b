"""Laws of mounts fitted to measured dynamic stiffness and loss angle."""
