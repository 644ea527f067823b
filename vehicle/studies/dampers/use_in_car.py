"""Use of the dampers of a car on roads: their velocities, and what comfort and stick share depend on.

The change of a result over the force at a velocity is the difference of two runs of the reduced engine, whose dampers
have `STEP` more and less force there, falling to zero at the neighbouring velocities, an octave away.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.model.laws.damper import damper_curve
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.studies.dampers.next_tests import PER_OCTAVE, Quantity, Use, speeds_between

CLASSES, SPEED, DURATION = ("A", "B", "C"), 80.0, 10.0
"""Classes of ISO 8608, speed of the car [km/h], and duration of each road [s]."""

STEP = 0.05
"""Change of the force of all dampers over its mean, for derivatives: above the resolution of a stick share."""


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
    both = np.concatenate([-size[::-1], size])
    return Use(both, shares, caption, quantities_of(car, Road(classes[0], speed, duration=DURATION), size))


def quantities_of(car: Car, road: Road, size: Vector) -> tuple[Quantity, ...]:
    """Return stick share and comfort of a car, with their slopes over the force of all dampers at velocities.

    Empty for a car with a controlled damper, or with a function in place of a law.

    Args:
        size: ascending velocities of one direction [m/s], `PER_OCTAVE` in an octave; (v/2,).
    """
    dampers = {damper.path: damper.law for damper in car.vehicle.composition.dampers}
    if any(law.controlled or law.function or law.friction_function for law in dampers.values()):
        return ()
    names = [f"damper_{wheel}_velocity" for wheel in car.vehicle.damped_wheels]
    names += [f"seat_rail_acc_{axis}" for axis in AXES]

    def results(changed: Car) -> Vector:
        run = changed.run(road, engine="reduced", channels=names, stated_errors=False)
        stuck = 1.0 - np.mean([run.slip_share(wheel) for wheel in car.vehicle.damped_wheels])
        return 100.0 * np.array([stuck, np.log(run.comfort().weighted.overall)])

    nodes = np.arange(0, size.size, PER_OCTAVE)
    grid = size[nodes]
    force = np.mean([damper_curve(law).force(grid) + law.coulomb_friction for law in dampers.values()], axis=0)
    slopes = np.zeros((2, 2 * size.size))
    for at, node in enumerate(nodes):
        change = np.where(np.arange(grid.size) == at, STEP * force, 0.0)
        band = {"velocity": [*-grid[::-1], *grid], "soft": [*-change[::-1], *-change], "firm": [*change[::-1], *change]}
        banded = car.with_({f"{p}.tested.band_{key}": values for p in dampers for key, values in band.items()})
        soft, firm = map(results, banded.law_band())
        # Both directions carry half of it, each in its direction.
        slopes[:, size.size + node] = (firm - soft) / (4.0 * STEP * force[at])
        slopes[:, size.size - 1 - node] = -slopes[:, size.size + node]
    stuck, comfort = results(car)
    share, weighted = f"{number(float(stuck), 3)} %", f"{number(float(np.exp(0.01 * comfort)), 3)} m/s2"
    return (
        Quantity(f"stick share on class {road.road}", share, slopes[0], "points"),
        Quantity(f"weighted acceleration on class {road.road}", weighted, slopes[1]),
    )
