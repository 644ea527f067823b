"""Specification of a car moved to another position, from which its coordinates then count.

The moved model is the same mechanical system. A body keeps its frame. Axis and anchor of each joint are taken in the
position q*, so that a part moves by T = exp(S1 (q1 - q1*)) exp(S2 (q2 - q2*)) T* in both models. The coordinates of
joints keep their values, by the reference of the joint. The coordinates of the flexible body and of fluids begin at
zero: the sites on the body contain the displacement Phi q* of their nodes.

In this position every bushing has the displacement zero: the site on its carrier moves to the site on its moving part.
Force and reaction then act at one point, and the forces inside the car are in equilibrium exactly. A tyre touches the
plate: its radius is the height of the wheel centre, along the plane of the wheel, and its force acts at the plate.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.row_layout import numeric
from vehicle.engines.simulation.rows import Rows
from vehicle.model.assembly.element_numbers import DECOUPLER, FLUID, FORCE

SCALARS = ("mode_", FLUID, DECOUPLER)
"""Beginnings of the names of coordinates that are no motion of a part."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MovedCar:
    """Position of a car, by the names of its specification.

    Attributes:
        poses: position [m] and quaternion of each body relative to its parent; (7,).
        joints: axis, anchor [m] and coordinate of each joint but free ones; (7,).
        sites: positions of the sites that differ from the design position, in the frame of their body [m]; (3,).
        numbers: changed custom fields: radii of tyres, arms of drive torques, and horizontal forces of rolling tyres.
        gravity: gravity less the acceleration of the car [m/s2]; (3,).
    """

    poses: dict[str, Vector]
    joints: dict[str, Vector]
    sites: dict[str, Vector]
    numbers: dict[str, Vector]
    gravity: Vector

    def place(self, spec: mujoco.MjSpec) -> None:
        """Move the specification of the car, or of a car with other modal coordinates."""
        spec.option.gravity = self.gravity
        for name, pose in self.poses.items():
            body = spec.body(name)
            body.pos, body.quat = pose[:3], pose[3:]
        for name, values in self.joints.items():
            joint = spec.joint(name)
            joint.axis, joint.pos, joint.ref = values[:3], values[3:6], float(values[6])
        for name, position in self.sites.items():
            spec.site(name).pos = position
        for name, values in self.numbers.items():
            spec.numeric(name).data = values


def moved_car(rows: Rows, position: Vector, gravity: Vector, preload: Vector) -> MovedCar:
    """Return a position of a car.

    Args:
        rows: rows of the car in its design position.
        position: coordinates of MuJoCo; (nq,).
        gravity: see `MovedCar`.
        preload: forces of the rows, with the horizontal forces of the tyres.
    """
    model, data = rows.model, mujoco.MjData(rows.model)
    data.qpos[:] = position
    mujoco.mj_kinematics(model, data)
    sites, numbers = _moved_sites(rows, data)
    for tyre in rows.layout.rolling.tyres:
        numbers[f"steady/{rows.names[tyre]}"] = preload[rows.layout.bushings.rows[tyre, :2]]
    return MovedCar(
        poses=_body_poses(model, data), joints=_joints(model, data), sites=sites, numbers=numbers, gravity=gravity
    )


def _body_poses(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, Vector]:
    """Return the poses of the bodies relative to their parents."""
    poses = {}
    for body in range(1, model.nbody):
        name, parent = str(model.body(body).name), int(model.body_parentid[body])
        if model.body_mocapid[body] >= 0 or name.startswith(SCALARS):
            continue
        inverse, quat, point = np.zeros(4), np.zeros(4), np.zeros(3)
        mujoco.mju_negQuat(inverse, data.xquat[parent])
        mujoco.mju_mulQuat(quat, inverse, data.xquat[body])
        mujoco.mju_rotVecQuat(point, data.xpos[body] - data.xpos[parent], inverse)
        poses[name] = np.concatenate([point, quat])
    return poses


def _joints(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, Vector]:
    """Return axis and anchor of the joints in the frames of their bodies, and their coordinates."""
    joints = {}
    for joint in range(model.njnt):
        name = str(model.joint(joint).name)
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE or name.startswith(SCALARS):
            continue
        body = int(model.jnt_bodyid[joint])
        frame = data.xmat[body].reshape(3, 3)
        # A ball joint begins anew at its position.
        ball = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_BALL
        at = 0.0 if ball else data.qpos[model.jnt_qposadr[joint]]
        joints[name] = np.concatenate(
            [frame.T @ data.xaxis[joint], frame.T @ (data.xanchor[joint] - data.xpos[body]), [at]]
        )
    return joints


def _moved_sites(rows: Rows, data: mujoco.MjData) -> tuple[dict[str, Vector], dict[str, Vector]]:
    """Return the changed sites, and the changed custom fields."""
    model, layout = rows.model, rows.layout
    points, modal = data.site_xpos.copy(), data.qpos[layout.modes.positions]
    body, moved, numbers = layout.modes.body, dict[str, Vector](), dict[str, Vector]()

    def put(site: int, point: Vector) -> None:
        owner = int(model.site_bodyid[site])
        moved[str(model.site(site).name)] = data.xmat[owner].reshape(3, 3).T @ (point - data.xpos[owner])

    for site in np.flatnonzero(model.site_bodyid == body).tolist() if modal.size else []:
        name = str(model.site(site).name)
        shape = next((shape for key in (name, name.rpartition("/")[0])
                      if (shape := numeric(model, f"shape/{key}")) is not None), None)  # fmt: skip
        if shape is not None:
            points[site] += data.xmat[body].reshape(3, 3) @ (shape.reshape(3, -1) @ modal)
            put(site, points[site])
    tyres = set(layout.tyres.tolist())
    for index, name in enumerate(rows.names):
        if name.startswith(FLUID):
            continue
        equality = model.equality(name).id
        part, carrier = int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])
        if index not in tyres:
            put(carrier, points[part])
            continue
        hub = data.xmat[int(model.site_bodyid[part])].reshape(3, 3)
        rolling, radius = numeric(model, f"rolling/{name}"), numeric(model, f"round/{name}")
        ground, shortened = points[carrier][2], 1.0
        if rolling is not None or radius is not None:
            # The lowest point of the tread, p + R (d_wheel - d), is on the plate: see rows.h.
            (long,) = (rolling[4:] if rolling is not None else np.zeros(0) if radius is None else radius).tolist()
            level = np.sqrt(1.0 - hub[2, 1] ** 2)
            short = float((points[part][2] + long * hub[2, 2] - ground) / level)
            patch, shortened = points[part] + (long - short) * hub[:, 2], short / long
            arm = short * (hub[:, 2] + hub[2, 1] / level * hub[:, 1] - [0.0, 0.0, 1.0 / level])
            put(part, patch)
            if rolling is not None:
                numbers[f"rolling/{name}"] = np.array([*rolling[:4], short])
                put(carrier, patch + arm)
            else:
                numbers[f"round/{name}"] = np.array([short])
                put(carrier, patch + arm * [0.0, 0.0, 1.0])
        else:
            # The patch is fixed to the wheel.
            for site in (part, carrier):
                put(site, np.array([*points[part][:2], ground]))
        drive = f"{FORCE}drive_{name.removeprefix('bushing/tyre_')}"
        if (torque := numeric(model, drive)) is not None:
            # The drive torque is the force times the loaded radius.
            numbers[drive] = np.array([*torque[:4], shortened, *torque[5:]])
    return moved, numbers
