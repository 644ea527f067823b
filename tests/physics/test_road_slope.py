"""Horizontal force of a rolling tyre on a road: load times effective slope, apart from the effective height."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.excitation.tyre_envelope import TyreEnvelope


def test_the_slope_of_a_drive_is_that_of_the_cams() -> None:
    wheels: tuple[tuple[str, float, Side], ...] = (("fr", 0.0, "right"), ("rr", 2.6, "right"))
    drive = RoadDrive(road="ramp:50x1000@30", speed=36.0, wheels=wheels, track=1.5)
    signal, cams = drive.signal(), drive.envelope
    assert cams is not None
    x, z = np.array([0.0, 30.0, 31.0, 90.0]), np.array([0.0, 0.0, 0.05, 0.05])
    for wheel, behind, _ in wheels:
        wanted = cams.height_and_slope(x, z, 10.0 * signal.time - behind)[1]
        np.testing.assert_allclose(signal.slope_velocity[wheel], 10.0 * wanted, atol=1e-9)
    assert np.max(signal.slope_velocity["fr"]) == pytest.approx(10.0 * 0.05, rel=1e-9)
    # The average over the contact patch has the slope of its height.
    assert not replace(drive, contact="patch").signal().slope_velocity
    # Height and slope of the road that rises from the plane belong together.
    rough = replace(drive, road="C", duration=4.0, contact="cams", rate=8000.0).signal()
    rise = np.diff(rough.displacement["fr"]) / np.diff(rough.time)
    mean = 0.5 * (rough.slope_velocity["fr"][1:] + rough.slope_velocity["fr"][:-1])
    start = slice(0, 4000)
    assert np.sum(rise[start]) == pytest.approx(np.sum(mean[start]), abs=0.02 * np.sum(np.abs(rise[start])))
    assert signal.identity() != replace(signal, slope_velocity={}).identity()
    with pytest.raises(DataError, match=r"slope velocity of fr; .* fr, rr"):
        replace(signal, slope_velocity={"fr": np.zeros(signal.time.size)})
    with pytest.raises(DataError, match="slope velocity of fr has shape"):
        replace(signal, slope_velocity={wheel: np.zeros(3) for wheel in ("fr", "rr")})


def test_engines_agree_on_a_small_cleat() -> None:
    """1 x 50 mm, so small that products of motions are nothing: RMS of every channel."""
    road = Road("cleat:1x50@15", speed=30.0, duration=3.5)
    drive = road.under(Car.load("focus_road").vehicle)
    car, signal = Car.load("focus_road", [*drive.overrides, "solver.timestep=2.5e-4"]), drive.signal()
    links = [name for name in car.vehicle.load_channels if name.startswith(("lower_", "upper_"))]
    channels = [*car.vehicle.acceleration_channels, *links]
    reduced, whole = (car.run(signal, engine=engine, channels=channels) for engine in ("reduced", "mujoco"))
    derived = car.run(replace(signal, slope_velocity={}), engine="reduced")
    start = round(1.2 * car.vehicle.solver.record_rate)
    ratios = {
        channel: np.std(np.array([run[channel][start:] for run in (reduced, derived, whole)]), axis=1)
        for channel in car.vehicle.acceleration_channels
    }
    worst = max(ratios, key=lambda channel: abs(ratios[channel][0] / ratios[channel][2] - 1.0))
    validated(
        "Tyres", f"RMS of {worst} on a cleat of 1 x 50 mm at 30 km/h, the channel with the largest difference",
        float(ratios[worst][0]), float(ratios[worst][2]), rel=5e-3, unit="m/s2",
        source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
    # Forces of ideal joints contain the force on the slope directly.
    forces = np.array([[run[name][start:] for name in links] for run in (reduced, whole)])
    difference, size = (np.sqrt(np.sum(np.var(values, axis=1))) for values in (forces[0] - forces[1], forces[1]))
    validated(
        "Reduced engine", "RMS difference of the forces of the rear links on a cleat of 1 x 50 mm to those of MuJoCo",
        float(difference / size), 0.0, abs=1e-2, source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
    # With the derivative of the height in place of the effective slope, wheels move otherwise along x.
    x = ratios["knuckle_fr_acc_x"]
    assert abs(x[1] / x[2] - 1.0) > 0.05


def test_engines_agree_on_a_cleat_but_for_products_of_motions() -> None:
    """20 x 50 mm and linear tyres: RMS of the part that changes its sign with the road, of every channel."""
    drive = Road("cleat:20x50@15", speed=30.0, duration=3.5).under(Car.load("focus_road").vehicle, ["one_sided=false"])
    car, signal = Car.load("focus_road", [*drive.overrides, "solver.timestep=2.5e-4"]), drive.signal()
    down = replace(
        signal,
        displacement={wheel: -z for wheel, z in signal.displacement.items()},
        slope_velocity={wheel: -rate for wheel, rate in signal.slope_velocity.items()},
    )
    start = round(1.2 * car.vehicle.solver.record_rate)
    channels = car.vehicle.acceleration_channels
    odd = []
    for engine in ("reduced", "mujoco"):
        up, other = (car.run(plates, engine=engine) for plates in (signal, down))
        odd.append(np.array([np.std(0.5 * (up[name] - other[name])[start:]) for name in channels]))
    rear = np.array([name in ("knuckle_rl_acc_y", "knuckle_rr_acc_y") for name in channels])
    validated(
        "Reduced engine", "RMS of 43 of 45 accelerations on a cleat of 20 x 50 mm, part that is odd in the road",
        odd[0][~rear], odd[1][~rear], rel=5e-3, unit="m/s2", source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
    validated(
        "Reduced engine", "RMS of the rear knuckles along y on a cleat of 20 x 50 mm, part that is odd in the road",
        odd[0][rear], odd[1][rear], rel=5e-3, unit="m/s2", source="second derivation: MuJoCo at 0.25 ms",
        reason="products of three motions: the links turn by finite angles, and the motion along y is the smallest "
        "of the car; on 5 x 50 mm these channels agree within 0.1 %",
    )  # fmt: skip


def test_effective_slopes_of_cams_are_differences_of_closed_heights() -> None:
    """Step, cleat, and a ramp of 10 %, whose lower corner, face and upper corner the cams touch one after the other."""
    tyre = TyreEnvelope(distance=0.08, half_length=0.45, half_height=0.29, order=1.5)

    def gap(offset):
        share = np.abs(offset / tyre.half_length)
        return np.where(
            share <= 1.0, tyre.half_height * (1.0 - np.maximum(1.0 - share**1.5, 0.0) ** (1.0 / 1.5)), np.inf
        )

    def step(at):
        return np.where(at >= 5.0, 0.03, np.maximum(0.0, 0.03 - gap(5.0 - at)))

    def cleat(at):
        over = (at >= 5.0) & (at <= 5.05)
        return np.where(over, 0.02, np.maximum(0.0, 0.02 - np.minimum(gap(5.0 - at), gap(5.05 - at))))

    def ramp(at):
        q = (0.1 * tyre.half_length / tyre.half_height) ** 3
        touch = tyre.half_length * (q / (1.0 + q)) ** (1.0 / 1.5)
        face = np.clip(at + touch, 5.0, 6.0)
        return np.where(at >= 6.0, 0.1, np.maximum(0.0, 0.1 * (face - 5.0) - gap(face - at)))

    at = np.linspace(4.0, 7.0, 3001)
    for name, x, z, height in (
        ("step of 30 mm", [0.0, 5.0, 5.0, 9.0], [0.0, 0.0, 0.03, 0.03], step),
        ("cleat of 20 x 50 mm", [0.0, 5.0, 5.0, 5.05, 5.05, 9.0], [0.0, 0.0, 0.02, 0.02, 0.0, 0.0], cleat),
        ("ramp of 100 mm over 1 m", [0.0, 5.0, 6.0, 9.0], [0.0, 0.0, 0.1, 0.1], ramp),
    ):
        front, rear = height(at + 0.04), height(at - 0.04)
        validated(
            "Roads and excitation", f"effective slope on a {name}",
            tyre.height_and_slope(np.array(x), np.array(z), at)[1], (front - rear) / 0.08, abs=1e-11, unit="-",
            source="closed form: heights of two superellipses on the corners",
        )  # fmt: skip
