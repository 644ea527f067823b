"""Visible shapes on the generated car: meshes without mass and without contact."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.model.parameters.composition import Composition, PlacedSpring
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.model.shapes.roles import ROLES, Part
from vehicle.model.shapes.scene import car_shapes
from vehicle.model.shapes.shape import Shape

Vector = npt.NDArray[np.float64]

SHELL_GROUP = 1
"""Visual group of everything on the trimmed body."""

ELSEWHERE = {"coil_spring": "coil"}
"""Role of a part that is not on a strut to the one that it is drawn as then."""

PART_GROUP = 2
"""Visual group of all other parts and of the rig."""


def visible_shapes(vehicle: Vehicle, *, rig: bool = True) -> dict[str, Shape]:
    """Shapes of a car and its rig at the design position, by name: of each part by its role, else a rod.

    Args:
        vehicle: the car.
        rig: draw what moves and stands under the wheels.
    """
    car = vehicle.composition
    points = {name: np.array(point) for name, point in car.points.items()}
    corners = {
        wheel.name: _around(points, f"_{wheel.name}")
        | {"wheel_center": np.array(wheel.center), "tyre_patch": np.array(wheel.patch)}
        for wheel in car.wheels
    }
    blocks = [one for one in car.connections if one.carrier == "world" and one.ground]
    supports = {one.name.rpartition("_")[2]: np.array(one.at) for one in blocks}
    return car_shapes(points, corners, supports, _drawn(vehicle, points, corners), rig=rig)


def _around(points: Mapping[str, Vector], suffix: str) -> dict[str, Vector]:
    """Points of one corner or side, without its ending; all of a car for what has none."""
    return {name.removesuffix(suffix): point for name, point in points.items() if name.endswith(suffix)}


def _drawn(
    vehicle: Vehicle, points: Mapping[str, Vector], corners: Mapping[str, Mapping[str, Vector]]
) -> Iterator[Part]:
    """Parts and springs of a car with the points that their roles need, or with their own.

    Those of a corner name wheel centre and contact patch whatever its template calls them.
    """
    car = vehicle.composition
    listed = [(one.path, one.name, one.shape, one.points, one.side) for one in car.parts]
    for spring in car.springs:
        ends = dict(zip(("lower", "upper"), spring.at, strict=True))
        listed.append((spring.path, spring.name, spring.shape, ends, float(np.sign(spring.at[0][1]))))
    for path, name, role, own, side in listed:
        base = path.rpartition(".")[2]
        suffix = name.removeprefix(base)
        around = corners.get(suffix[1:]) or _around(points, suffix)
        needed = set(ROLES[role][1]) if role in ROLES else {""}
        if needed <= set(around):
            chosen = around
        else:
            role = ELSEWHERE.get(role, role)
            chosen = {key: np.array(place) for key, place in (own if len(own) > 1 else _reach(car, name, own)).items()}
        if role != "none":
            yield Part(name=base, role=role, points=chosen, suffix=name.removeprefix(base), left=side < 0.0)


def _reach(car: Composition, name: str, own: Mapping[str, Point]) -> dict[str, Point]:
    """Points of a part, and those at which others hang on it."""
    joints = {joint.name: joint.at for part in car.parts if part.parent == name for joint in part.joints}
    return {**own, **joints}


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
