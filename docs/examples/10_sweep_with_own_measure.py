"""A sweep by numbers of your own: plain functions of a run."""

import numpy as np

from vehicle import Car, road, sweep


def largest_jerk(run):
    """Largest jerk of the seat rail [m/s3]."""
    return np.abs(np.gradient(run["seat rail z"][run.evaluated], run.time[1])).max()


def time_above(run):
    """Time with more than 1 m/s2 at the seat rail [s]."""
    return (np.abs(run["seat rail z"][run.evaluated]) > 1.0).sum() * run.time[1]


# Functions by name, beside figures of the catalogue.
measure = {"jerk": largest_jerk, "time above 1 m/s2": time_above, "comfort": "weighted"}
vary = {"front.damper.coulomb_friction": [0, 30, 60, 120]}
table = sweep(Car.load("sedan"), vary, road("B", 80, duration=8), measure=measure, engine="reduced")

# A row for each car, in the order of `vary`.
for row in range(4):
    jerk, time, comfort = (table.column(name)[row] for name in measure)
    friction = vary["front.damper.coulomb_friction"][row]
    print(f"friction {friction:3} N: jerk {jerk:6.1f} m/s3, above 1 m/s2 for {time:.2f} s, comfort {comfort:.3f} m/s2")
