"""Tunable parameters, commands, communication steps and warnings of an FMU against other ways to the same motion."""

import re
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")

from tests.handover.fmu.master import Instance, drive, plates_of, written
from tests.validation import validated
from vehicle.engines.reduced.validity import LARGEST_ANGLE
from vehicle.runs.car import Car, Road
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.signals.excitation.signal import Signal

OUTPUTS = ["seat_rail_displacement_z", "seat_rail_acc_z", "tyre_fl_force_z", "damper_fl_velocity", "damper_fr_force"]
SECONDS = 1.0


def difference(found, wanted) -> float:
    """Return the largest deviation of an output over its peak."""
    peaks = np.max(np.abs(wanted - wanted[:, :1]), axis=1)
    return float(np.max(np.max(np.abs(found - wanted), axis=1) / peaks))


def of_car(folder: Path, overrides: list[str], signal: Signal, values: dict[str, float]) -> np.ndarray:
    """Return the outputs of the car of Bommer 2006 with other parameters, with variables set before the run."""
    instance = Instance(written(Car.load("focus", overrides), folder), started=False)
    instance.set(values)
    return drive(instance, signal, plates_of(signal, SECONDS), OUTPUTS, 5)


def of_both(quantity: str, value: float) -> dict[str, float]:
    """Return a variable of both dampers."""
    return {f"damper_{wheel}_{quantity}": value for wheel in ("fr", "fl")}


def test_friction_is_that_of_the_car_with_this_friction(tmp_path, high_piece):
    laws = ['front.damper.friction_law="stribeck"', "front.damper.stribeck_velocity=0.03"]
    laws += ["front.damper.stribeck_exponent=1", "front.damper.stribeck_friction=150"]
    wanted = of_car(tmp_path, [*laws, "front.damper.coulomb_friction=60"], high_piece, {})
    changed = ["front.damper.coulomb_friction=20", "front.damper.stribeck_velocity=0.1"]
    values = of_both("coulomb_friction", 60.0) | of_both("stribeck_velocity", 0.03)
    validated(
        "Exported FMUs", "friction set as parameters: deviation from the car with this friction over the peak",
        difference(of_car(tmp_path, [*laws, *changed], high_piece, values), wanted), 0.0, abs=1e-10,
        source="second derivation: another FMU with these values in its resources",
    )  # fmt: skip
    assert difference(of_car(tmp_path, [*laws, *changed], high_piece, {}), wanted) > 0.01


@pytest.mark.parametrize("scale", [0.6, 2.0])
def test_the_curve_scale_is_nearly_that_of_the_poles(scale, tmp_path, high_piece, car):
    viscous = car.vehicle.damper.viscous
    assert viscous is not None
    wanted = of_car(tmp_path, [f"front.damper.viscous={scale * viscous}"], high_piece, {})
    chosen = [0, 2, 3]
    scaled = of_car(tmp_path, [], high_piece, of_both("curve_scale", scale))
    added = of_car(tmp_path, [], high_piece, of_both("coefficient_command", (scale - 1.0) * viscous))
    for found in (scaled, added):
        assert difference(found[chosen], wanted[chosen]) < 1e-3
    assert difference(scaled, added) < 1e-10
    assert difference(of_car(tmp_path, [], high_piece, {})[chosen], wanted[chosen]) > 0.02


def test_a_force_command_acts_as_on_the_poles(tmp_path):
    """A car without friction under a constant force F of a damper: xi = -e F (exp(s t) - 1)/s."""
    car = Car.load("focus", ["front.damper.coulomb_friction=0"])
    instance = Instance(written(car, tmp_path))
    instance.set({"damper_fl_force_command": 300.0})
    rows = []
    for _ in range(400):
        instance.step(1e-3)
        rows.append(instance.get(["seat_rail_displacement_z", "knuckle_fl_displacement_z", "damper_fl_velocity"]))
    found, model = np.array(rows).T, car.poles
    time, index = 1e-3 * np.arange(1, 401), model.matrices.system.inputs.index("fl")
    xi = -300.0 * model.force[:, index, None] * np.expm1(np.multiply.outer(model.poles, time)) / model.poles[:, None]
    shapes = model.outputs(["seat_rail_acc_z", "knuckle_fl_acc_z"]).poles
    wanted = np.vstack([(shapes @ xi).real, (model.slip[index] @ xi).real])
    validated(
        "Exported FMUs", "constant force of a damper as a command: deviation over the peak",
        difference(found, wanted), 0.0, abs=1e-10,
        source="closed form: step response of the poles",
    )  # fmt: skip
    # A pull of the damper lifts the wheel and lowers the body.
    assert found[1, 20] > 0.0 > found[0, 20]


def test_steps_of_a_millisecond_equal_short_steps(tmp_path):
    """The road is a cubic between samples of 1 ms, which displacement and velocity at both ends give exactly."""
    car = Car.load("focus_road")
    ride = Road("C", speed=80, duration=SECONDS + 0.2).under(car.vehicle)
    signal, fmu = ride.signal(), written(car.with_(ride.overrides), tmp_path)
    plates = plates_of(signal, SECONDS)
    short = drive(Instance(fmu, started=False), signal, plates, OUTPUTS, 5)
    long = drive(Instance(fmu, started=False), signal, plates[::5], OUTPUTS, 1, 1e-3)
    validated(
        "Exported FMUs", "communication steps of 1 ms on a road: deviation from steps of 0.2 ms over the peak",
        difference(long, short), 0.0, abs=1e-10,
        source="second derivation: shorter communication steps",
    )  # fmt: skip


def test_a_lifted_tyre_gives_one_warning(tmp_path):
    car = Car.load("focus_road").with_(["driving.speed=20"])
    instance = Instance(written(car, tmp_path))
    for k in range(200):
        phase = 60.0 * (k + 1) * 1e-3
        instance.set({"plate_fl_displacement": 0.05 * np.sin(phase), "plate_fl_velocity": 3.0 * np.cos(phase)})
        instance.step(1e-3)
    lifted = [text for text in instance.messages if "tyre fl would lift off" in text]
    assert len(lifted) == 1 and lifted[0].startswith("at 0.0")


def test_all_tyres_that_lift_at_once_give_warnings(tmp_path):
    """Both front tyres lift for 19 ms over a bump of 30 ms: all that a check finds is said, not only its first."""
    instance = Instance(written(Car.load("focus_road").with_(["driving.speed=20"]), tmp_path))
    tyres, below = ["tyre_fr_force_z", "tyre_fl_force_z"], 0
    for time in np.arange(1e-3, 0.15, 1e-3):
        phase = 2.0 * np.pi * np.clip((time - 0.054) / 0.03, 0.0, 1.0)
        for wheel in ("fr", "fl"):
            height, rate = 0.025 * (1.0 - np.cos(phase)), 0.025 * 2.0 * np.pi / 0.03 * np.sin(phase)
            instance.set({f"plate_{wheel}_displacement": height, f"plate_{wheel}_velocity": rate})
        instance.step(1e-3)
        below += max(instance.get(tyres)) < 0.0
    assert 16 < below < 24
    lifted = [text for text in instance.messages if "would lift off" in text]
    assert [text.split(":")[0] for text in lifted] == 2 * [lifted[0].split(":")[0]]


def test_a_part_that_turns_too_far_gives_a_warning(tmp_path):
    """The part and the amplitude of the plate at which the reduced engine, too, leaves its valid range."""
    car, time = Car.load("focus_road"), np.arange(0.0, 0.8001, 1e-3)
    lift = 0.5 * (1.0 - np.cos(2.0 * np.pi * time / 1.6))
    signal = Signal(time=time, displacement={wheel: 0.06 * lift * (wheel == "fl") for wheel in car.vehicle.wheels})
    # Without stated errors, as in an FMU, the rotation alone tells the range.
    (warning, *_) = simulated_run(car, signal, None, "reduced", None, stated=False)[1].statistics.warnings
    part, angle = re.match(r"(\w+) rotates by (\S+) deg", warning).groups()  # type: ignore[union-attr]
    fmu = written(car, tmp_path)
    for share, expected in ((0.8, False), (1.25, True)):
        height = 0.06 * share * LARGEST_ANGLE / np.radians(float(angle)) * lift
        instance = Instance(fmu)
        for z, rate in zip(height[1:], np.gradient(height, time)[1:], strict=True):
            instance.set({"plate_fl_displacement": z, "plate_fl_velocity": rate})
            instance.step(1e-3)
        turned = [text for text in instance.messages if "rotates by more than 2.9 deg" in text]
        assert any(f"{part} rotates" in text for text in turned) == expected == bool(turned)
