"""Flexible trimmed body: wireframe, beams, modes, and the modal superelement that the car uses."""
