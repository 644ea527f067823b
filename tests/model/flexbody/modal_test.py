"""A modal test of the shipped body at twenty points: its true modes as a universal file holds them, with errors."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from vehicle.model.flexbody.body_model import body_model
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.records.geometry import Geometry, ModeShape
from vehicle.signals.records.uff_writer import write

POINTS = tuple(load_vehicle(None).composition.attachments())
"""All points of the car on the body."""


@lru_cache(maxsize=1)
def true_body():
    return body_model(load_vehicle(None))


def write_modes(path, *, points=POINTS, places=True, modal_mass=2.5, count=9, speed=1.0, noise=0.0, scale=0.0):
    """Datasets 15 and 55 of the body.

    Args:
        path: the file.
        points: names of nodes of the body.
        places: with their places.
        modal_mass: of the modes [kg]; shapes grow with its root, but where it is below 1e-3, as if it were told wrong.
        count: how many modes.
        speed: factor of the frequencies.
        noise: standard deviation of a component over the RMS of its shape [1].
        scale: standard deviation of the scale of a mode [1], as a driving point measures it.
    """
    body, random = true_body(), np.random.default_rng(15)
    at = [body.node_index(name) for name in points]
    shapes = []
    for i in range(count):
        own = body.shapes[i, at] * np.sqrt(modal_mass if modal_mass > 1e-3 else 1.0)
        own = own + noise * np.sqrt(np.mean(own**2)) * random.standard_normal(own.shape)
        values = np.zeros((len(points), 6), dtype=complex)
        values[:, :3] = own * (1.0 + scale * random.standard_normal())
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
    write(path, [], "modal test", geometry if places else None, shapes)
