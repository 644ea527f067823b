"""Both variants of x86-64 give equal bits of the rows of MuJoCo: AVX2 and SSE2 run every law to the same last digit."""

from typing import Any

import numpy as np
import pytest

from tests.core.recorded_march import CASES
from vehicle.core.library import core
from vehicle.engines.simulation.simulation_record import SIGNATURES
from vehicle.runs.car import Car, Road

TRACK = {"maxwell_stiffness": 0.0, "chamber_stiffness": 3e6, "track_mass": 30.0, "track_damping": 700.0}
DECOUPLER = {
    "decoupler_gap": 3e-4,
    "decoupler_mass": 1.0,
    "decoupler_damping": 60.0,
    "decoupler_stiffness": 2e3,
    "decoupler_seat": 2e6,
}
FURTHER: dict[str, tuple[str, dict[str, Any]]] = {
    "curve of a damper": ("focus", {"front.damper.viscous_law": "degressive"}),
    "track and decoupler": ("focus", {f"hydromount.{name}": value for name, value in (TRACK | DECOUPLER).items()}),
}
"""Laws without one of the reduced car alone."""

ALL = CASES | FURTHER


@pytest.mark.skipif(core().core_variant() != 3, reason="this processor has one variant")
@pytest.mark.parametrize("case", ALL)
def test_runs_of_mujoco_have_equal_bits(case, monkeypatch):
    name, changes = ALL[case]
    car, runs = Car.load(name, changes), []
    for variant in (3, 2):
        for function in SIGNATURES:
            monkeypatch.setattr(core(), f"core_{function}_d", getattr(core(), f"{function}_d{variant}"))
        runs.append(car.run(Road("C", speed=80.0, duration=0.7), engine="mujoco", skip=0.5))
    wide, narrow = runs
    assert wide.recording.channels.keys() == narrow.recording.channels.keys()
    for channel, values in wide.recording.channels.items():
        assert np.isfinite(values).all() and (np.ptp(values) > 0.0 or "plate" in channel)
        np.testing.assert_array_equal(narrow[channel], values, err_msg=channel)
