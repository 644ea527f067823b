"""Visible shapes of car and rig: meshes made from hardpoints, for the MJCF and its pictures."""

from vehicle.shapes.scene import SHELL, car_shapes
from vehicle.shapes.shape import Shape

__all__ = ["SHELL", "Shape", "car_shapes"]
