"""Item 49: a car that falls over by itself is refused in both engines by what moves, and its modes list it."""

import json
import math
import re
from dataclasses import dataclass, field

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.commands import modes
from vehicle.engines.linear.natural_modes import grows
from vehicle.engines.simulation.judgement import require_finite
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.car import Car
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import evaluate

ROAD = random_road(rms=1e-4, seed=1, wheel="fr", duration=1.0)

FALLING = [
    "bushings.arm_rear.stiffness=[1e4, 1e4, 1e4]",
    "bushings.suspension_mount.stiffness=[1e4, 1e4, 1e5]",
    "body.inertia.ixx=1200",
    "gravity=20",
]
"""Within every range, and yet: soft arms and mounts under twice the weight, and the wheels run away."""


@pytest.mark.parametrize("engine", ["mujoco", "reduced", "auto"])
def test_an_unstable_car_is_rejected_with_the_moving_part(engine):
    with pytest.raises(ConfigurationError) as caught:
        Car.load(None, FALLING).run(ROAD, engine=engine)
    message = str(caught.value)
    assert re.match(
        "the car is statically unstable: front wheel fore-aft, sides in phase grows by a factor of e in ", message
    )
    assert "the most loaded is front.bushings.suspension_mount.stiffness.x (10000)" in message
    assert "body.mass (813 kg), body.cog and gravity (20 m/s2)" in message


def test_its_modes_list_what_grows(car, capsys):
    falling = Car.load(None, FALLING).modes()
    growing = [mode for mode in falling if mode.grows]
    assert growing and all(mode.growth > 0.01 and mode.damping_ratio < 0.0 for mode in growing)
    assert any(mode.damping_ratio == pytest.approx(-1.0) for mode in growing), "a real pole, which modes used to hide"
    assert not any(mode.grows for mode in car.modes())
    arguments = [word for setting in FALLING for word in ("--set", setting)]
    assert modes.main([*arguments, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert len(printed["growing"]) == len(growing)
    assert modes.main(arguments) == 0
    assert f"this car does not stand: {', '.join(printed['growing'])} grows by itself" in capsys.readouterr().out


def test_round_off_does_not_grow():
    poles = np.array([1e-5 + 0j, 1e-3 + 1e5j, -1.0 + 2j, 1e-3 + 0j, 0.5 + 100j])
    np.testing.assert_array_equal(grows(poles), [False, False, False, True, True])


def test_values_that_are_no_numbers_do_not_leave_a_run(car):
    recording = car.run(ROAD, engine="reduced").recording
    for bad in (np.nan, np.inf, 1e9):
        values = recording["seat_rail_acc_z"].copy()
        values[400] = bad
        broken = dict(recording.channels) | {"seat_rail_acc_z": values}
        with pytest.raises(SimulationError, match=r"channel seat_rail_acc_z is \S+ m/s2 at t = 0\.4000 s"):
            require_finite(type(recording)(**{**fields(recording), "channels": broken}))


def fields(recording):
    names = ("time", "units", "excited", "pose_time", "poses", "statistics")
    return {name: getattr(recording, name) for name in names}


@dataclass(frozen=True)
class Endless:
    """A measure that overflows."""

    channels: tuple[str, ...] = ("seat_rail_acc_z",)
    units: dict[str, str] = field(default_factory=lambda: {"loud": "-", "never": "s"})

    def __call__(self, run):
        return {"loud": math.inf, "never": math.nan}


def test_a_sweep_writes_a_reason_where_it_would_write_inf():
    road = random_road(rms=1e-4, seed=1, wheel="fr", duration=1.0, lower_band_edge=1.0)
    cases = [Case(source=road, engine="reduced"), Case(overrides=tuple(FALLING), source=road, engine="reduced")]
    result, other = evaluate(cases, Endless())
    assert result.reason.startswith("SimulationError: loud: infinite") and not result.values
    assert other.reason.startswith("ConfigurationError: the car is statically unstable")
