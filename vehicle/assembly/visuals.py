"""Visible shapes on the generated car: meshes without mass and without contact."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.parameters.composition import PlacedSpring
from vehicle.shapes.shape import Shape

SHELL_GROUP = 1
"""Visual group of everything on the trimmed body."""

PART_GROUP = 2
"""Visual group of all other parts and of the rig."""


def add_shapes(
    spec: mujoco.MjSpec,
    shapes: Mapping[str, Shape],
    origins: Mapping[str, npt.NDArray[np.float64]],
    springs: Iterable[PlacedSpring],
) -> None:
    """Give a specification a visible mesh for every shape; masses, inertias and joints stay what they are.

    Body frames are parallel to the vehicle frame in the design position, so a mesh is only shifted: v - origin.

    Args:
        spec: specification of the car on its rig; changed in place.
        shapes: shapes at the design position in the vehicle frame, by name.
        origins: where each body frame sits in the design position [m], by body name.
        springs: of the car; a coil lies between two bodies and goes with the lower one.
    """
    borne = {spring.name: spring.parts[0] for spring in springs}
    for name, shape in shapes.items():
        body = borne.get(shape.part, shape.part)
        vertices = np.asarray(shape.mesh.vertices) - origins[body]
        spec.add_mesh(
            name=name,
            uservert=vertices.ravel(),
            userface=np.asarray(shape.mesh.faces).ravel(),
            # An open surface has no volume, and the mass of a shape is not used anyway.
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        spec.add_material(name=name, rgba=shape.rgba, specular=0.3, shininess=0.4)
        spec.body(body).add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=name,
            material=name,
            contype=0,
            conaffinity=0,
            mass=0.0,
            group=SHELL_GROUP if body == "body" else PART_GROUP,
        )
