"""Simulated modal test of the shipped body at twenty points: a universal file with its true modes and random errors."""

from functools import lru_cache

import numpy as np

from vehicle.model.flexbody.body_model import body_model
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.uff_writer import write

POINTS = tuple(load_vehicle(None).composition.attachments())
"""Names of all points of the car on the body."""


@lru_cache(maxsize=1)
def true_body():
    return body_model(load_vehicle(None))


def write_modes(path, *, points=POINTS, with_positions=True, modal_mass=2.5, count=9, speed=1.0, noise=0.0, scale=0.0):
    """Write datasets 15 and 55 of the body.

    Args:
        path: universal file.
        points: names of nodes of the body.
        with_positions: include node positions.
        modal_mass: modal mass [kg]; scales the shapes, unless below 1e-3 (a wrong modal mass in the file).
        count: number of modes.
        speed: factor of the frequencies [1].
        noise: standard deviation of a component over the RMS of its shape [1].
        scale: standard deviation of the scale of a mode [1], an error of the driving-point measurement.
    """
    body, random = true_body(), np.random.default_rng(15)
    at = [body.node_index(name) for name in points]
    shapes = []
    for i in range(count):
        shape = body.shapes[i, at] * np.sqrt(modal_mass if modal_mass > 1e-3 else 1.0)
        shape = shape + noise * np.sqrt(np.mean(shape**2)) * random.standard_normal(shape.shape)
        values = np.zeros((len(points), 6), dtype=complex)
        values[:, :3] = shape * (1.0 + scale * random.standard_normal())
        shapes.append(
            ModeShape(
                number=i + 1,
                frequency=float(body.frequencies[i]) * speed,
                damping_ratio=float(body.damping_ratio[i]),
                modal_mass=modal_mass,
                points=tuple(points),
                shape=values,
                name=body.mode_names[i],
            )
        )
    geometry = Geometry(points={name: body.positions[body.node_index(name)].tolist() for name in points})
    write(path, [], "modal test", geometry if with_positions else None, shapes)
