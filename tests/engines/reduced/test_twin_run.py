"""Linear twin on a road that repeats, by FFT: against time integration of the same linear car, and the expectation."""

import numpy as np
import pytest

from tests.engines.reduced.test_road_expectation import PERIOD, RAIL, RATE, SPEED, linear_car, road_of, wheels_of
from tests.validation import validated
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.road_expectation import density, repeating_lines, track_sources, weighting_width
from vehicle.engines.reduced.twin_run import HIGHEST, damping_of_run, twin_run
from vehicle.runs.car import Car
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.signal import Signal, uniform_time

__all__ = ["linear_car"]

SAMPLES = round(PERIOD * RATE)

OTHER = np.array([2500.0, 2300.0, 1300.0, 1200.0])
"""Damping constants of the second car [N s/m], in the order of its dampers."""


def plates_of(car: Car, *, mirrored: bool = False) -> dict[str, np.ndarray]:
    """Return one period of the plates on a road of class C or on its mirror image."""
    road = road_of(car, quadruples=True)
    opposite: dict[Side, Side] = {"right": "left", "left": "right"}
    return {
        wheel: road.height(-behind, SPEED / RATE, SAMPLES, opposite[side] if mirrored else side, 0.4 * RATE / SPEED)
        for wheel, (behind, side) in wheels_of(car).items()
    }


def marched(car: Car, channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the last of eight periods, by time integration of the car itself."""
    plates = {wheel: np.concatenate([np.tile(z, 8), z[:1]]) for wheel, z in plates_of(car).items()}
    signal = Signal(time=uniform_time(samples=8 * SAMPLES + 1, timestep=1.0 / RATE), displacement=plates)
    record = simulate_reduced(
        car.poles, signal, dampers=[each.law for each in car.vehicle.composition.dampers], record_rate=RATE,
        tyre_load=car.static.tyre_load, channels=channels, present_load=False,
    )  # fmt: skip
    return {name: record.channels[name][-SAMPLES - 1 : -1] for name in channels}


def weighted(histories: dict[str, np.ndarray]) -> float:
    """Return the weighted RMS of one period of the seat rail [m/s2]."""
    frequency = np.fft.rfftfreq(SAMPLES, 1.0 / RATE)
    return float(
        np.sqrt(
            sum(
                2.0 * np.sum(np.abs(np.fft.rfft(histories[name]) / SAMPLES * curve.transfer_function(frequency)) ** 2)
                for name, curve in zip(RAIL, map(weighting, ("Wd", "Wd", "Wk")), strict=True)
            )
        )
    )


def test_a_twin_with_other_damping_is_the_car_with_these_dampers(linear_car: Car):
    """Compare the twin of the poles of one car with the march of a second car that has its own poles.

    The lines above 100 Hz, which the twin leaves out, and the interpolation of the plates between samples make the
    difference.
    """
    dampers = linear_car.matrices.damper_names
    front, rear = 2400.0, 1250.0
    second = linear_car.with_(
        {"front.damper.force": [-front, front], "front.damper.viscous": front, "rear.damper.viscous": rear}
    )
    channels = (*RAIL, *(f"{name}_{quantity}" for name in dampers for quantity in ("velocity", "force")))
    run = marched(second, channels)
    damping = damping_of_run(second.poles, [each.law for each in second.vehicle.composition.dampers], run, slice(None))
    assert damping == pytest.approx([front if name[-2] == "f" else rear for name in dampers], rel=1e-6)
    twin = twin_run(linear_car.poles, damping, plates_of(linear_car), PERIOD, channels, SAMPLES)
    validated(
        "Reduced engine", "weighted seat rail of the linear twin by FFT on class C", weighted(twin), weighted(run),
        rel=1e-5, unit="m/s2", source="second derivation: time integration of a car with these dampers",
    )  # fmt: skip
    for name in channels:
        found, wanted = (np.fft.rfft(each[name])[1 : int(HIGHEST * PERIOD) + 1] for each in (twin, run))
        assert np.sum(np.abs(found - wanted) ** 2) < 1e-7 * np.sum(np.abs(wanted) ** 2), name


def test_the_mean_over_a_period_and_its_mirror_image_is_the_expectation(linear_car: Car):
    """The twin's own runs against the closed sum over the lines of the class, within 0.001 %."""
    lines = repeating_lines(road_of(linear_car), SPEED, RATE, PERIOD)
    sources = track_sources(road_of(linear_car), SPEED, wheels_of(linear_car), lines.frequency)
    power = density(linear_twin(linear_car.poles, RAIL, lines.frequency, sources).responses(OTHER))
    expected = np.sqrt(np.sum(power * [weighting_width(lines, name) for name in ("Wd", "Wd", "Wk")]))
    runs = [
        weighted(twin_run(linear_car.poles, OTHER, plates_of(linear_car, mirrored=mirrored), PERIOD, RAIL, SAMPLES))
        for mirrored in (False, True)
    ]
    assert np.sqrt(np.mean(np.square(runs))) == pytest.approx(expected, rel=1e-5)
    # On one of both alone, the quadruples leave 0.3 %; independent phases leave 2 %.
    assert runs[0] == pytest.approx(expected, rel=6e-3)
