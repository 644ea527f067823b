"""Wheelbase filtering: on a road the rear axle repeats the front one L/V later, which cancels motions of the body."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.model.assembly.test_four_wheels import RIDE, ride_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.iso_road import drive

SPEED, WHEELBASE = 20.0, 2.6
EDGE = SPEED / WHEELBASE
"""V/L [Hz], 7.69."""


class Hump:
    """A hump of 0.1 m in both tracks: all frequencies up to 30 Hz at 20 m/s, and a plane before and behind it."""

    words = "hump"

    repeats = True

    @property
    def bare(self) -> Hump:
        return self

    def contact(self, start: float, step: float, steps: int, side: str, highest: float) -> tuple[np.ndarray, None]:
        place = start + step * np.arange(steps)
        return np.asarray(1e-3 * np.exp(-(((place - 30.0) / 0.1) ** 2))), None


def equal_axles(folder: Path) -> Car:
    """The ride car with its front axle 1.3 m before and behind the centre of gravity, without friction."""
    (folder / "ride.toml").write_text(RIDE, encoding="utf-8")
    table: dict[str, Any] = ride_table(1e9)
    table["front"]["damper"]["coulomb_friction"] = 0.0
    table["rear"] = copy.deepcopy(table["front"])
    middle = table["body"]["cog"][0]
    for name, x in (("front", middle - 0.5 * WHEELBASE), ("rear", middle + 0.5 * WHEELBASE)):
        points = table[name]["hardpoints"]
        shift = x - points["center"][0]
        table[name]["hardpoints"] = {key: [at[0] + shift, *at[1:]] for key, at in points.items()}
    height = table["body"]["cog"][2]
    table["outputs"] = {
        name: {"on": "body", "at": [middle + reach, 0.0, height]}
        for name, reach in (("seat_rail", 0.0), ("ahead", -1.0), ("behind", 1.0))
    }
    return Car(vehicle_of(table, folder))


@pytest.fixture(scope="module")
def over_a_hump(tmp_path_factory) -> Run:
    car = equal_axles(tmp_path_factory.mktemp("ride"))
    drive_of_car = Road("C", 3.6 * SPEED).under(car.vehicle)
    places = {wheel: (behind, side) for wheel, behind, side in drive_of_car.wheels}
    assert {wheel: behind for wheel, (behind, _) in places.items()} == pytest.approx(
        {"fr": 0.0, "fl": 0.0, "rr": WHEELBASE, "rl": WHEELBASE}
    )
    # The slowest motion, pitch at 1 Hz with a tenth of its critical damping, is over behind the hump.
    return car.run(drive(Hump(), speed=SPEED, wheels=places, duration=16.0), engine="reduced")


def at_frequency(run: Run, values: np.ndarray, frequency: float) -> float:
    """|Fourier integral| of a motion that begins and ends at rest."""
    return float(np.abs(np.sum(values * np.exp(-2j * np.pi * frequency * run.time))))


def test_heave_has_notches_at_odd_halves_of_speed_over_wheelbase(over_a_hump):
    heave = over_a_hump["seat_rail_acc_z"]
    for n in range(3):
        notch, open_to = (at_frequency(over_a_hump, heave, f * EDGE) for f in (n + 0.5, n + 1.0))
        assert notch < 1e-4 * open_to, n


def test_pitch_has_notches_at_multiples_of_speed_over_wheelbase(over_a_hump):
    pitch = over_a_hump["ahead_acc_z"] - over_a_hump["behind_acc_z"]
    for n in range(1, 4):
        notch, open_to = (at_frequency(over_a_hump, pitch, f * EDGE) for f in (float(n), n - 0.5))
        assert notch < 1e-4 * open_to, n
