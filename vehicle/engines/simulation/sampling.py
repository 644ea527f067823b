"""Buffers of the stepping loop (`vehicle/core/source/stepping.h`) for the samples of a run."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import Table


class Samples(NamedTuple):
    """Buffers with a row for each sample; only load channels use `load_frames`, they and stops `load_springs`.

    `poses` has a row for each stored pose; `modal_pull` is a working array.
    """

    places: Table
    turn: Table
    modal_position: Table
    modal_velocity: Table
    modal_pull: Vector
    damper_velocity: Table
    coefficient: Table
    actuator: Table
    solved: Table
    explicit: Table
    rate: Vector
    branch: Vector
    poses: Table
    spring_rates: Table
    load_frames: Table
    load_springs: Table
    contact: Table
    rubber: Table
    heading: Table
    pushed: Vector


def empty_samples(count: int, sources: Mapping[str, Any]) -> Samples:
    """Return buffers for a number of samples from the arrays of the record Sources, filled with zeros."""
    shapes = {name: array.shape for name, array in sources.items() if isinstance(array, np.ndarray)}
    widths: dict[str, tuple[int, ...]] = {
        "places": (3 * shapes["sites"][0],),
        "turn": shapes["orientation"][1:],
        "modal_position": shapes["modal"][1:],
        "modal_velocity": shapes["modal"][1:],
        "damper_velocity": shapes["dampers"],
        "coefficient": shapes["coefficient"],
        "actuator": shapes["actuator"],
        "solved": shapes["explicit"],
        "explicit": shapes["explicit"],
        "rate": shapes["rate"],
        "branch": shapes["branch"],
        "poses": shapes["position"],
        "spring_rates": shapes["spring_rates"],
        "load_frames": (12 * shapes["load_bodies"][0],),
        "load_springs": (2 * shapes["load_springs"][0],),
        "contact": shapes["contact"][1:],
        "rubber": shapes["rubber"][1:],
        "heading": shapes["heading"][1:],
        "pushed": (),
    }
    buffers = {name: np.zeros((count, *width)) for name, width in widths.items()}
    return Samples(modal_pull=np.zeros(shapes["modal_force"]), **buffers)
