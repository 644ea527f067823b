"""Visible shapes of car and rig: meshes built from the points of parts according to their roles, for the MJCF."""

from vehicle.model.shapes.roles import Part, part_shapes
from vehicle.model.shapes.scene import SHELL
from vehicle.model.shapes.shape import Shape

__all__ = ["SHELL", "Part", "Shape", "part_shapes"]
