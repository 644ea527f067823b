"""Cars that lack dampers, on one axle or both, gravity, damping, a moving road or outputs, in both engines."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.physics import rolling_car as small
from tests.physics.rolling_car import rolling_car
from vehicle import sweep
from vehicle.commands.summary_text import summary_text
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.rest import half_cosine
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.records.run_summary import read_summary

UNDAMPED = ("damping", "viscous", "coulomb_friction", "maxwell_damping")
"""Last keys of the numbers of damping."""


def without_dampers(folder: Path, axle: str) -> Car:
    """Return the sedan with hubs on springs in place of an axle, which has no dampers then."""
    (folder / "corner.toml").write_text(small.TEMPLATE)
    table = tomllib.loads((VEHICLES / "sedan" / "vehicle.toml").read_text())
    points, tyre = table[axle]["hardpoints"], table[axle]["bushings"]["tyre"]
    parts = {
        name: {"mass": mass, "inertia": 3 * [small.SPINS[name]], "offset": [0.0, 0.0, 0.0]}
        for name, mass in small.MASSES.items()
    }
    mount = {"stiffness": [2e5, 8e5, 4e4], "damping": 3 * [300.0], "rotational_stiffness": 3e4}
    table[axle] = {
        "template": "corner",
        "hardpoints": {name: points[name] for name in ("wheel_center", "tyre_patch")},
        "parts": parts,
        "bushings": {"tyre": tyre, "mount": mount},
    }
    return Car(vehicle_of(table, folder), folder=folder)


def undamped(name: str) -> Car:
    """Return a shipped car all of whose damping is zero."""
    zero: dict[str, Any] = {}
    for parameter in Car.load(name).search():
        first, last = parameter.path.split(".")[0], parameter.path.rsplit(".", 1)[-1]
        if last in UNDAMPED and first != "driving":
            zero[parameter.path] = [0.0, 0.0, 0.0] if isinstance(parameter.value, list | tuple) else 0.0
    assert len(zero) > 5
    return Car.load(name, zero)


CARS = {
    "no dampers": lambda folder: rolling_car(folder, 15.0, gravity=9.81),
    "no dampers, on plates": lambda folder: rolling_car(folder, 0.0, gravity=9.81),
    "no dampers, no damping": lambda folder: rolling_car(
        folder, 15.0, gravity=9.81, damping=0.0, overrides=["*.bushings.tyre.damping=[0.0, 0.0, 0.0]"]
    ),
    "no gravity": lambda folder: rolling_car(folder, 0.0),
    "no dampers in front": lambda folder: without_dampers(folder, "front"),
    "no dampers behind": lambda folder: without_dampers(folder, "rear"),
    "no damping of a car": lambda folder: undamped("sedan"),
    "no damping on two wheels": lambda folder: undamped("focus"),
    "no damping with a seat": lambda folder: undamped("focus_road_seated"),
    "no hydromount branch": lambda folder: Car.load("focus", ["engine.bushings.hydromount.maxwell_stiffness=0"]),
}


def smooth(wheels: tuple[str, ...], samples: int = 1001) -> Signal:
    """Return a signal of low frequencies, which both engines resolve, with another level on each of the wheels."""
    time = uniform_time(samples=samples, timestep=1e-3)
    z = 2e-3 * half_cosine(samples=samples, timestep=1e-3, length=0.4) * np.sin(2.0 * np.pi * 3.0 * time)
    return Signal(time=time, displacement={wheel: (1.0 - 0.2 * k) * z for k, wheel in enumerate(wheels)})


@pytest.mark.parametrize("name", CARS)
def test_both_engines_have_the_same_channels_and_levels(name: str, tmp_path: Path) -> None:
    """Before, without dampers: ValueError; with none in front, the rear dampers were called front dampers."""
    car = CARS[name](tmp_path)
    runs = [car.run(smooth(car.vehicle.wheels), engine=engine).recording for engine in ("reduced", "mujoco")]
    assert tuple(runs[0].channels) == tuple(runs[1].channels) == car.vehicle.channels
    reduced, whole = ({channel: float(np.std(values)) for channel, values in run.channels.items()} for run in runs)
    # Vertical motions and forces: others have a large share of second order.
    names = [channel for channel in whole if channel.endswith(("acc_z", "force_z", "velocity", "_force"))]
    assert names
    errors = {c: abs(reduced[c] / whole[c] - 1.0) for c in names if whole[c] > 1e-9}
    assert max(errors.values()) < 0.02, {channel: error for channel, error in errors.items() if error > 0.02}
    assert all(reduced[c] < 1e-9 for c in names if whole[c] <= 1e-9)


@pytest.mark.parametrize(("name", "dampers"), [("no dampers", ()), ("no dampers in front", ("rr", "rl"))])
def test_sweeps_and_files_name_the_dampers_that_there_are(name: str, dampers: tuple[str, ...], tmp_path: Path) -> None:
    CARS[name](tmp_path).save(tmp_path / "vehicle.toml")
    car = Car.load(tmp_path / "vehicle.toml")
    signal = smooth(("fr",), 2001)
    table = sweep(car, {"rear.bushings.tyre.stiffness.z": [1.9e5, 2.1e5]}, signal, skip=0.0)
    slips = [name for name in table.results[0].values if name.startswith("slip_share")]
    assert slips == [f"slip_share_{wheel}" for wheel in dampers] and np.ptp(table.column("weighted_z")) > 0.0
    folder = car.run(signal, engine="reduced").save(tmp_path / "run")
    summary = read_summary(folder)
    assert tuple(summary.slip_shares) == tuple(summary.first_slip_s) == dampers
    assert ("\ndamper " in summary_text(summary)) == bool(dampers)
    assert (folder / "time.png").is_file()


def test_a_batch_has_the_forces_of_stops_behind_an_axle_without_dampers(tmp_path):
    """The dampers of a car are not numbered like its wheels: a batch adds each stop to the force of its own damper."""
    stop = "rear.damper.stop={displacement=[-0.03, -0.0002, 0.0002, 0.03], force=[-2800.0, 0.0, 0.0, 2800.0]}"
    car = without_dampers(tmp_path, "front").with_([stop])
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    names, load = ["damper_rr_force", "damper_rl_force"], car.static.tyre_load
    run: dict[str, Any] = {"record_rate": 1000.0, "channels": names, "step": 5e-4}
    signal = smooth(car.vehicle.wheels, 401)
    batch = simulate_batch([car.poles], signal, dampers=[laws], tyre_load=[load], **run)
    one = simulate_reduced(car.poles, signal, dampers=laws, tyre_load=load, **run)
    for name in names:
        # Single precision against double precision; the stop is a quarter of the force.
        assert np.std(batch.channels[name][0] - one[name]) < 1e-4 * np.std(one[name])
