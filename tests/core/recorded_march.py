"""Marches of real runs, whose records are kept before the core sees them: to be run again by any library.

`python -m tests.core.recorded_march FILE` writes those of all cases to a file for `march_again`.
"""

import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.core.march_again import Fields, copied
from vehicle.core.records import packed
from vehicle.engines.reduced import group_run
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.runs.car import Car, Road

RUBBER = {
    "front.bushings.arm_rear.friction_force": [300.0] * 3,
    "front.bushings.arm_rear.friction_stroke": [2e-4] * 3,
    "front.bushings.tyre.one_sided": True,
}
STRIBECK = {"front.damper.friction_law": "stribeck", "front.damper.stribeck_friction": 150.0}
PRESLIDING = {"front.damper.friction_law": "presliding", "front.damper.presliding_stiffness": 5e5}


def controlled(law: str, **values: Any) -> dict[str, Any]:
    """Return the changes that control the dampers of both axles."""
    changes = {"law": law, **values}
    return {f"{axle}.damper.control.{name}": value for axle in ("front", "rear") for name, value in changes.items()}


CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "focus": ("focus", {}),
    "stribeck": ("focus", STRIBECK),
    "presliding": ("focus", PRESLIDING),
    "rubber friction and tyres that lift off": ("focus", RUBBER),
    "side forces": ("focus", {"front.damper.side_force_coefficient": 0.1}),
    "focus_road": ("focus_road", {}),
    "rolling, with rubber friction": ("focus_road", RUBBER),
    "skyhook": ("focus_road", controlled("skyhook", delay=0.004)),
    "on-off": ("focus_road", controlled("hybrid_on_off", control_period=0.002)),
    "sedan": ("sedan", {}),
    "kinematic_reference": ("kinematic_reference", {}),
}
"""Cars and changes: all laws of the reduced car."""

SINGLE = ("focus", "stribeck", "presliding", "rubber friction and tyres that lift off", "side forces", "focus_road")
"""Cases that run in single precision, too."""

ALL = [*((case, False) for case in CASES), *((case, True) for case in SINGLE)]
"""Case, and True for single precision."""


def recorded(case: str, *, single: bool = False) -> Fields:
    """Return the fields of the first block of a run on a rough road, in double or single precision."""
    name, changes = CASES[case]
    car, blocks, groups = Car.load(name, changes), list[Fields](), list[tuple[Any, ...]]()
    real, begin = packed, group_run.GroupRun.__init__
    drive: Any = Road("C", speed=80.0, duration=1.2)
    if name == "focus":
        drive = random_road(rms=5e-3, seed=3, wheel="fr", duration=1.2)

    def keep(record: str, fields: Fields) -> Any:
        blocks.append({name: copied(value) for name, value in fields.items()})
        return real(record, fields)

    def note(self: Any, *given: Any, **more: Any) -> None:
        groups.append(given)
        begin(self, *given, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(group_run, "packed", keep)
        patch.setattr(group_run.GroupRun, "__init__", note)
        car.run(drive, engine="reduced", skip=0.5)
        if single:
            models, _, dampers, loads, signal, *_ = groups[0]
            simulate_batch(
                [*models] * 2,
                signal,
                dampers=[*dampers] * 2,
                record_rate=car.vehicle.solver.record_rate,
                tyre_load=[*loads] * 2,
                channels=["seat_rail_acc_z", "damper_fr_force"],
            )
    element = np.float32 if single else np.float64
    return next(fields for fields in blocks if fields["table"].dtype == element)


if __name__ == "__main__":
    marches = [(recorded(case, single=single), single) for case, single in ALL]
    Path(sys.argv[1]).write_bytes(pickle.dumps(marches))
