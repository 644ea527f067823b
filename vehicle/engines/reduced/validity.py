"""Valid range of the reduced engine: small rotations, and tyres in contact if they are linear.

The matrices belong to the design position. A part that rotates by an angle a changes the direction of its forces by a
and lengths by a^2/2. A linear tyre that lifts off would pull. Both are monitored during a run and reported as warnings.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.model.parameters.force_elements import LIFTS, PULLS

LARGEST_ANGLE = 0.05
"""Maximum rotation of a part [rad]. Measured against MuJoCo on roads of increasing level: up to this rotation the
comfort value agrees within 0.1 %, the RMS of every channel of body, engine and dampers within 0.2 %, and only the
lateral acceleration of the knuckle, which consists of such rotations, is 1 % off. At 0.13 rad (a road of 43 mm RMS) it
is 5 % off, and comfort still below 0.1 %. A small lateral acceleration may have a larger relative error: 20 % with only
one rear wheel of `focus_road` driven, where it is a tenth of the vertical acceleration. For rolling tyres on class C
(0.07 to 0.17 rad) see `ERROR_ON_CLASS_C`."""

ERROR_ON_CLASS_C = "comfort within 0.4 %, lateral acceleration of a knuckle within 15 %"
"""Difference of the reduced engine from MuJoCo on class C, for messages. Measured with the shipped cars on four wheels
at 50, 80 and 120 km/h, 20 s, MuJoCo at its own step: unweighted comfort of `kinematic_reference` 0.12 % up to 80 km/h
and 0.38 % at 120 km/h, of the other cars at most 0.06 %, weighted comfort at most 0.06 %; lateral acceleration of a
knuckle 3 to 5 % at 50 km/h and 13 to 15 % at 120 km/h, where linear tyres pull for a moment in place of lifting off."""

LARGEST_ANGLE_ON_ROADS = 0.17
"""Maximum rotation of a part [rad] on roads for the errors in `ERROR_ON_CLASS_C`, measured at 0.07 to 0.17 rad."""

ERROR_IN_RANGE = "comfort within 0.1 %"
"""Difference of the reduced engine from MuJoCo inside its valid range, see `LARGEST_ANGLE`, for messages."""

REMEDY = ": use the MuJoCo engine"
"""End of a warning that names the engine to use."""

LARGEST_STATED_ANGLE = 0.25
"""Maximum rotation of a part [rad] in a run whose errors are stated: up to this rotation the second order states every
channel of the shipped and of eight new cars within a factor of two (`python -m tests.benchmarks.alarms`)."""

CHECK_EVERY = 16
"""Samples between two checks: 16 ms at 1 kHz, a tenth of the period of the fastest rigid-body mode."""

LONGEST_CHECK_INTERVAL = 0.016
"""Maximum time between two checks [s], which limits the stride for sample rates below 1 kHz."""


def check_stride(interval: float) -> int:
    """Return the number of samples from one check to the next for a sample interval [s]."""
    return max(min(CHECK_EVERY, int(LONGEST_CHECK_INTERVAL / interval + 1e-9)), 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Validity:
    """Extremes of a run, compared with the valid range of the matrices.

    Attributes:
        angles: largest rotation of each body [rad].
        loads: lowest tyre load of each wheel [N].
        one_sided: wheels whose tyres cannot pull.
        limit: maximum rotation of the valid range [rad].
    """

    angles: Mapping[str, float]
    loads: Mapping[str, float]
    one_sided: frozenset[str]
    limit: float = LARGEST_ANGLE

    @property
    def within_limits(self) -> bool:
        """Return True if the motion stayed within the valid range of the matrices, `limit` for every part."""
        return all(angle <= self.limit for angle in self.angles.values())

    def warnings(self) -> tuple[str, ...]:
        """Return warnings for the exceeded limits."""
        messages = []
        largest = max(self.angles, key=lambda body: self.angles[body])
        if not self.within_limits:
            messages.append(
                f"{largest} rotates by {np.degrees(self.angles[largest]):.3g} deg, but the linear geometry of the "
                f"reduced engine is valid up to {np.degrees(self.limit):.3g} deg{REMEDY}"
            )
        for wheel, load in self.loads.items():
            if load < 0.0 and wheel not in self.one_sided:
                messages.append(f"tyre {wheel} {LIFTS} (lowest load {load:.0f} N); {PULLS}")
        return tuple(messages)


def rotating_bodies(matrices: CarMatrices) -> tuple[str, ...]:
    """Return one representative of each group of rigidly connected bodies, which have equal rotations."""
    representative: dict[str, str] = {}
    for body in matrices.body_rows:
        # The first body that is met represents all that are carried by the same body.
        representative.setdefault(matrices.carried_by.get(body, body), body)
    return tuple(body for body in representative.values() if body not in matrices.spinning)


def rotation_outputs(model: PoleModel, bodies: Sequence[str]) -> Outputs:
    """Return the rotations of bodies about three axes as outputs; (3 bodies, ...)."""
    rotations = np.vstack([model.matrices.body_rows[body][3:] for body in bodies]) @ model.modal
    no_plates = np.zeros((len(rotations), len(model.matrices.system.inputs)))
    return Outputs(poles=rotations, height=no_plates, velocity=no_plates)


def tyre_outputs(model: PoleModel) -> Outputs:
    """Return the dynamic tyre loads, without static values, as outputs."""
    return model.outputs([f"tyre_{wheel}_force_z" for wheel in model.matrices.system.inputs])
