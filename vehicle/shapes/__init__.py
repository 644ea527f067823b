"""Visible shapes of car and rig: meshes made from the points of parts by their roles, for the MJCF and its pictures."""

from vehicle.shapes.roles import Part, part_shapes
from vehicle.shapes.scene import SHELL
from vehicle.shapes.shape import Shape

__all__ = ["SHELL", "Part", "Shape", "part_shapes"]
