"""Expected mean squares on a class of roads: against time integration over a whole period, and closed forms."""

from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.road_expectation import (
    Lines,
    band_width,
    damper_speeds,
    density,
    integral_lines,
    repeating_lines,
    track_sources,
    weighting_width,
)
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.iso_road import IsoRoad, Side
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.tyre_envelope import CAMS, TyreEnvelope

SPEED, RATE, PERIOD = 80.0 / 3.6, 1000.0, 6.0

VISCOUS = {
    "front.damper.viscous_law": "linear", "front.damper.viscous": 1600, "front.damper.coulomb_friction": 0,
    "rear.damper.viscous": 1500, "rear.damper.coulomb_friction": 0, "driving.speed": SPEED,
}  # fmt: skip
"""Changes that make the sedan linear: dampers without friction and table."""

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in "xyz")


@pytest.fixture(scope="module")
def linear_car() -> Car:
    """Return the sedan with viscous dampers."""
    return Car.load("sedan", {**VISCOUS, "front.damper.velocity": [-1, 1], "front.damper.force": [-1600, 1600]})


def wheels_of(car: Car) -> dict[str, tuple[float, Side]]:
    """Return distance behind the foremost wheel and side of each wheel, in the order of the inputs."""
    wheels = {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
    foremost = min(wheel.center[0] for wheel in wheels.values())
    return {
        name: (wheels[name].center[0] - foremost, "right" if wheels[name].side > 0.0 else "left")
        for name in car.poles.matrices.system.inputs
    }


def road_of(car: Car, **changes: Any) -> IsoRoad:
    """Return a road of class C."""
    usual: dict[str, Any] = {"level": CLASSES["C"], "seed": 3, "track": 1.5, "patch": 0.1}
    return IsoRoad(**usual | changes)


def twin_of(car: Car, road: IsoRoad, lines: Lines, channels: tuple[str, ...]):
    """Return the responses of channels to both sources of a road."""
    return linear_twin(
        car.poles, channels, lines.frequency, track_sources(road, SPEED, wheels_of(car), lines.frequency)
    )


def test_the_expectation_is_the_mean_over_a_whole_period_of_the_road_and_its_mirror_image(linear_car: Car):
    """March the linear car over two periods and read the second.

    In the mirror image of a road the difference of the tracks has the other sign, so that the products of mean and
    difference cancel in the sum of both: the mean over both equals the expectation over the phases.
    """
    road, wheels = road_of(linear_car), wheels_of(linear_car)
    samples = round(PERIOD * RATE)
    tyres = tuple(f"tyre_{wheel}_force_z" for wheel in wheels)
    dampers = tuple(f"{name}_velocity" for name in linear_car.matrices.damper_names)
    channels = (*RAIL, *tyres, *dampers)
    lines = repeating_lines(road, SPEED, RATE, PERIOD)
    found = np.zeros((len(channels), lines.frequency.size))
    opposite: dict[Side, Side] = {"right": "left", "left": "right"}
    for mirrored in (False, True):
        plates = {}
        for wheel, (behind, side) in wheels.items():
            track = opposite[side] if mirrored else side
            height = road.height(-behind, SPEED / RATE, samples, track, 0.4 * RATE / SPEED)
            # Eight periods: the slowest motion, the whole car on its tyres along the road, has decayed by then.
            plates[wheel] = np.concatenate([np.tile(height, 8), height[:1]])
        signal = Signal(
            time=uniform_time(samples=8 * samples + 1, timestep=1.0 / RATE), displacement=plates, source="period"
        )
        record = simulate_reduced(
            linear_car.poles, signal, dampers=[each.law for each in linear_car.vehicle.composition.dampers],
            record_rate=RATE, tyre_load=linear_car.static.tyre_load, channels=channels, present_load=False,
        )  # fmt: skip
        history = np.stack([record.channels[name] for name in channels])[:, -samples - 1 : -1]
        spectrum = np.fft.rfft(history, axis=1)[:, np.round(lines.frequency * PERIOD).astype(int)]
        found += 0.5 * 2.0 * np.abs(spectrum / samples) ** 2
    twin = twin_of(linear_car, road, lines, (*RAIL, *tyres))
    expected = density(twin.responses(twin.viscous))
    factors = np.stack([weighting_width(lines, name) / lines.width for name in ("Wd", "Wd", "Wk")])
    weighted = [float(np.sqrt(np.sum(of * factors))) for of in (found[:3], expected[:3] * lines.width)]
    source = "second derivation: time integration of the linear car over whole periods of the road and its mirror image"
    subject = "Roads and excitation"
    validated(
        subject, "expected weighted seat rail of a linear car on class C", weighted[1], weighted[0], rel=1e-5,
        unit="m/s2", source=source,
    )  # fmt: skip
    loads = np.sqrt(found[3:7].sum(axis=1))
    # The plates are interpolated between samples: 4e-5 of the loads, which have waves up to 220 Hz.
    validated(
        subject, "expected tyre loads of a linear car on class C", np.sqrt(expected[3:] @ lines.width), loads,
        rel=1e-4, unit="N", source=source,
    )  # fmt: skip
    speeds = np.sqrt(found[7:].sum(axis=1))
    validated(
        subject, "expected damper velocities of a linear car on class C", damper_speeds(twin, twin.viscous, lines),
        speeds, rel=1e-5, unit="m/s", source=source,
    )  # fmt: skip


def test_the_integral_over_the_class_is_that_of_dense_lines(linear_car: Car):
    """Compare 300 lines with equal steps of f^0.3 to 6 000 lines of a road that repeats after 100 s."""
    road = road_of(linear_car)
    values = []
    for lines in (integral_lines(road, SPEED, RATE), repeating_lines(road, SPEED, RATE, 100.0)):
        twin = twin_of(linear_car, road, lines, RAIL)
        power = density(twin.responses(twin.viscous))
        weighted = np.sum(power * [weighting_width(lines, name) for name in ("Wd", "Wd", "Wk")])
        values.append(np.sqrt([weighted, *(power @ band_width(lines, (2.0, 50.0))), *(power @ lines.width)]))
    # The edges of the band fall into cells of 0.1 to 1 Hz; the whole integral agrees closely.
    assert values[0][1:4] == pytest.approx(values[1][1:4], rel=5e-4)
    assert values[0][[0, 4, 5, 6]] == pytest.approx(values[1][[0, 4, 5, 6]], rel=5e-5)


def test_leakage_of_a_flat_density_leaves_the_width_of_the_band():
    """The window sinc^2((f - f_k) T) has the integral 1/T: a flat density reads the width of the band."""
    lines = Lines(np.arange(1, 40000) / 200.0, np.full(39999, 1.0 / 200.0))
    read = band_width(lines, (20.0, 50.0), duration=2.0)
    # The window continues outside 0 to 200 Hz: 2/(2 pi^2 20 Hz T) of a line at 20 Hz.
    assert read.sum() == pytest.approx(30.0, rel=1e-3)
    assert band_width(lines, (20.0, 50.0)).sum() == pytest.approx(30.0, rel=1e-12)


def test_the_weighting_is_that_of_the_standard_at_each_line():
    """|W|^2 df at a line."""
    lines = Lines(np.array([1.0, 8.0]), np.array([0.5, 0.25]))
    expected = np.abs(weighting("Wk").transfer_function([1.0, 8.0])) ** 2 * [0.5, 0.25]
    assert weighting_width(lines, "Wk") == pytest.approx(expected)


def test_cams_have_no_closed_form(linear_car: Car):
    """They take the upper envelope of the road."""
    cams = TyreEnvelope.of(CAMS, radius=0.3, patch=0.1)
    with pytest.raises(ConfigurationError, match="set --contact patch"):
        track_sources(road_of(linear_car, envelope=cams), SPEED, wheels_of(linear_car), np.array([1.0]))
