"""Motion of the points of a car from a few of its displacements, for the moving picture of the page.

The displacements q are heave, roll and pitch of the body and the lift of each wheel centre, q = R u. Between them the
car takes the shape of least strain energy, as in the static reduction of Guyan: with a basis Z of the motions that the
joints permit, S = Z' (K + w^2 M) Z and T = R Z,

    u = Phi q,  Phi = Z S^-1 T' (T S^-1 T')^-1.

The small w lets a car on rolling tyres be held in place. Source: R. J. Guyan, AIAA Journal 3 (1965) 380.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.engines.linear.load_rows import displacement_rows
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.validity import rotating_bodies
from vehicle.handover.page.packed_numbers import text
from vehicle.runs.car import Car
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.signal import Signal

HOLD = 2.0 * np.pi * 0.1
"""Angular frequency w [rad/s], far below that of the heave mode."""

FULL = 127
"""Maximum integer of a shape: a step of 1/127 is finer than a pixel at a displacement of 300 pixels of 3 m."""

HEAVE_ROLL_PITCH = (2, 3, 4)
"""Rows of a body: height of the centre of gravity, rotations about x and y."""

FASTEST_TURN = 0.5
"""Minimum of the largest rotation of a watched part over that of all parts. The limit is the same for all parts, so a
part that rotates less is not the first beyond it, unless settings change the ratio by a factor of two."""


def picture_rows(car: Car) -> Vector:
    """Return the rows R of the displacements that the picture shows over the velocity coordinates, (3 + wheels, n)."""
    rows = car.matrices.body_rows
    lifts = [rows[wheel.part][2] for wheel in car.vehicle.composition.wheels]
    return np.vstack([rows["body"][list(HEAVE_ROLL_PITCH)], *lifts])


def static_shapes(car: Car, rows: Vector) -> Vector:
    """Return the displacements Phi of the velocity coordinates in the shapes of least energy; (n, k).

    Args:
        rows: rows R of the displacements that are held; (k, n).
    """
    system = car.matrices.system
    basis = scipy.linalg.null_space(system.constraints) if len(system.constraints) else np.eye(len(system.mass))
    stiffness = 0.5 * (system.stiffness + system.stiffness.T) + HOLD**2 * system.mass
    # T = R Z and S^-1 T'.
    held = rows @ basis
    flexibility = np.linalg.solve(basis.T @ stiffness @ basis, held.T)
    return np.asarray(basis @ flexibility @ np.linalg.inv(held @ flexibility))


def moving_picture(car: Car) -> dict[str, Any]:
    """Return the shapes of the points of the car for the page: integers of each displacement, and their steps.

    The points are those of `car_wireframe`, whose plates move with the input: plates of the page, wheel by wheel.
    """
    wire = car_wireframe(car.model)
    shapes = np.einsum("ijk,kl->lij", wire.motion, static_shapes(car, picture_rows(car)))
    steps = np.max(np.abs(shapes), axis=(1, 2)) / FULL
    # Integers of -127 to 127 times a step for each shape.
    rounded = np.rint(shapes / steps[:, None, None]).astype(np.int8)
    plates = [car.matrices.system.inputs.index(wheel.name) for wheel in car.vehicle.composition.wheels]
    return {"shapes": text(rounded.tobytes()), "steps": steps.tolist(), "plates": plates}


def turning_parts(car: Car, signal: Signal) -> list[int]:
    """Return the largest rotations of parts on a signal, as indices of `rotation_outputs`; see `FASTEST_TURN`."""
    matrices = car.matrices
    rows = np.vstack([matrices.body_rows[body][3:] for body in rotating_bodies(matrices)])
    loads = displacement_rows(matrices, rows)
    recording = simulate_reduced(
        car.poles,
        replace(signal, profile={}),
        dampers=[damper.law for damper in car.vehicle.composition.dampers],
        record_rate=car.vehicle.solver.record_rate / 8.0,
        tyre_load=car.static.tyre_load,
        channels=loads.names,
        loads=loads,
    )
    peaks = np.array([np.max(np.abs(recording[name])) for name in loads.names])
    return [int(index) for index in np.flatnonzero(peaks >= FASTEST_TURN * np.max(peaks))]
