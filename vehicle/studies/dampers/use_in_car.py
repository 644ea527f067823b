"""Use of the dampers of a car on roads: shares of the time of their velocities."""

from collections.abc import Sequence

import numpy as np

from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.studies.dampers.next_tests import Use, speeds_between

CLASSES, SPEED, DURATION = ("A", "B", "C"), 80.0, 10.0
"""Classes of ISO 8608, speed of the car [km/h], and duration of each road [s]."""


def use_in_car(car: Car, classes: Sequence[str] = CLASSES, speed: float = SPEED) -> Use:
    """Return the velocities of all dampers of a car on roads, from `SLOWEST` on, with their shares of the time.

    Args:
        car: car that can roll.
        classes: road classes, which count alike.
        speed: speed of the car [km/h].
    """
    names = [f"{damper.name}_velocity" for damper in car.vehicle.composition.dampers]
    runs = [car.run(Road(each, speed, duration=DURATION), engine="reduced", channels=names) for each in classes]
    velocity = np.concatenate([run.recording[name][run.evaluated] for run in runs for name in names])
    size = speeds_between(float(np.max(np.abs(velocity))))
    # Bins reach from each velocity to the geometric means with its neighbours.
    edges = np.concatenate([size[:1], np.sqrt(size[1:] * size[:-1]), size[-1:]])
    counts = [np.histogram(sign * velocity, edges)[0] for sign in (-1.0, 1.0)]
    shares = np.concatenate([counts[0][::-1], counts[1]]) / sum(map(np.sum, counts))
    classes_text = f"{', '.join(classes[:-1])} and {classes[-1]}" if len(classes) > 1 else classes[0]
    caption = f"velocities of the dampers of {car.vehicle.name}, roads of class {classes_text} at {speed:g} km/h"
    return Use(np.concatenate([-size[::-1], size]), shares, caption)
