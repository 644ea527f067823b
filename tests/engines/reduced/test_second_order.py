"""What the linear geometry of the reduced engine lacks: products of two motions, from the equations and from MuJoCo."""

from functools import cache

import numpy as np
import numpy.typing as npt
import pytest

from tests.engines.reduced.second_order import Equations, Motion, linear_motion, second_order
from tests.validation import validated
from vehicle.engines.reduced import quadratic_forms as forms_module
from vehicle.engines.reduced.linear_motion import run_inputs, state_spectra
from vehicle.engines.reduced.second_order import SecondOrder
from vehicle.runs.car import Car
from vehicle.signals.excitation.band import period_of
from vehicle.signals.excitation.rest import half_cosine
from vehicle.signals.excitation.signal import Signal, uniform_time

Vector = npt.NDArray[np.float64]

RATE, PERIOD, PERIODS = 1000, 2000, 4
"""Sample rate [Hz], samples of a period, periods of a run."""

RMS = 5e-3
"""RMS of the plates [m]: vertical accelerations of the wheels as on class B at 80 km/h."""

WITHOUT_FRICTION = [
    "front.damper.viscous_law=linear", "front.damper.viscous=2500", "front.damper.coulomb_friction=0",
    "rear.damper.coulomb_friction=0", "driving.speed=22", "solver.timestep=0.0005",
]  # fmt: skip
"""Changes that leave `kinematic_reference` and `sedan` nonlinear by their geometry alone."""


@cache
def heights() -> Vector:
    """Return a period of the plates [m], lines from 0.5 to 30 Hz with equal velocity; (4, samples)."""
    lines = np.arange(1, 61)
    phases = 2.0 * np.pi * np.random.Generator(np.random.PCG64(3)).random((4, lines.size))
    z = np.array([period_of(np.exp(1j * phase) / lines, lines, PERIOD) for phase in phases])
    return np.asarray(z * (RMS / np.std(z)))


@cache
def car(name: str) -> Car:
    """Return a car with linear laws."""
    return Car.load(name, WITHOUT_FRICTION)


@cache
def last_period(name: str, scale: float) -> dict[str, Vector]:
    """Return the last period of the accelerations in MuJoCo on plates with `scale` times the heights."""
    z = np.tile(heights(), PERIODS)
    z = np.hstack([z, z[:, :1]]) * half_cosine(samples=z.shape[1] + 1, timestep=1.0 / RATE, length=0.5)
    wheels = car(name).vehicle.wheels
    signal = Signal(
        time=uniform_time(samples=z.shape[1], timestep=1.0 / RATE),
        displacement={wheel: scale * z[car(name).matrices.system.inputs.index(wheel)] for wheel in wheels},
    )
    run = car(name).run(signal)
    return {channel: run.recording[channel][-1 - PERIOD : -1] for channel in car(name).vehicle.acceleration_channels}


def even_part(name: str, scale: float = 1.0) -> dict[str, Vector]:
    """Return the part of the accelerations in MuJoCo that does not change sign with the plates, without its mean."""
    up, down = last_period(name, scale), last_period(name, -scale)
    parts = {channel: 0.5 * (up[channel] + down[channel]) for channel in up}
    return {channel: part - part.mean() for channel, part in parts.items()}


def test_rotation_of_a_part_by_hand() -> None:
    """A place at r from the origin of a free part that rotates by theta moves by theta x r + theta x (theta x r)/2."""
    equations, size = Equations(car("kinematic_reference")), car("kinematic_reference").matrices.system.size
    model, data = equations.model, equations.data
    first = int(model.jnt_dofadr[model.body("arm_rl").jntadr[0]]) + 3
    displacement = np.zeros((size, 1))
    displacement[first : first + 3, 0] = angle = np.array([3e-4, -5e-4, 4e-4])
    still = linear_motion(car("kinematic_reference").matrices, np.zeros((4, 2)), 1.0)
    still = still._replace(**{name: values[:, :1] for name, values in still._asdict().items()})
    equations.at(still, 0, 0.0)
    arm = data.site_xpos[model.site("place/knuckle_rl").id] - data.xpos[model.body("arm_rl").id]
    places = equations.products(still._replace(displacement=displacement)).places[:, 0]
    row = equations.channels.index("knuckle_rl_acc_x")
    validated(
        "Reduced engine", "second-order displacement of a knuckle on an arm that rotates by 0.7 mrad",
        1e9 * places[row : row + 3], 1e9 * 0.5 * np.cross(angle, np.cross(angle, arm)),
        source="closed form: theta x (theta x r) / 2", peak=1e-5, unit="nm",
    )  # fmt: skip


def test_what_is_even_in_the_road_is_the_second_order_of_the_equations_of_motion() -> None:
    motion = linear_motion(car("kinematic_reference").matrices, heights(), 1.0 / RATE)
    even = even_part("kinematic_reference")
    expected = second_order(car("kinematic_reference"), motion, 1.0 / RATE, every=2)
    errors = {channel: float(np.std(part - expected[channel]) / np.std(part)) for channel, part in even.items()}
    # Light damper tops are the least resolved by the step of MuJoCo.
    groups = {
        "at a knuckle": (("knuckle",), 0.015),
        "on body and engine": (("seat", "engine", "body", "roof", "suspension"), 0.02),
        "at a damper top": (("damper_top",), 0.03),
    }
    for place, (names, tolerance) in groups.items():
        validated(
            "Reduced engine",
            f"part of an acceleration {place} that keeps its sign with the road, largest difference in share of it",
            max(error for channel, error in errors.items() if channel.startswith(names)), 0.0,
            source="second derivation: products of the linear motion in the equations, without solver and integrator",
            abs=tolerance,
        )  # fmt: skip
    reduced = {channel: motion_of("kinematic_reference", channel, motion) for channel in even}
    up, down = last_period("kinematic_reference", 1.0), last_period("kinematic_reference", -1.0)
    odd = {channel: 0.5 * (up[channel] - down[channel]) for channel in even}
    validated(
        "Reduced engine",
        "part of an acceleration that changes its sign with the road, largest difference in share of it",
        max(float(np.std(odd[channel] - reduced[channel]) / np.std(odd[channel])) for channel in even), 0.0,
        source="second derivation: MuJoCo on a road and the same road upside down", abs=0.01,
    )  # fmt: skip


@pytest.mark.parametrize("name", ["kinematic_reference", "sedan"])
def test_second_order_from_patterns_of_the_motion(name: str) -> None:
    """Quadratic forms over patterns and single poles, against the equations at each sample and a solution per line."""
    model, samples = car(name).poles, heights().shape[1]
    motion = linear_motion(car(name).matrices, heights(), 1.0 / RATE)
    # The engine has the load on slopes already.
    expected = second_order(car(name), motion, 1.0 / RATE, every=2, present_load=False)
    still = np.zeros((4, samples))
    record = {
        f"damper_{wheel}_{kind}": still[0] for wheel in car(name).vehicle.wheels for kind in ("force", "velocity")
    }
    record |= {f"law_{index}": still[0] for index in range(len(model.laws))}
    inputs = run_inputs(model, (heights(), still[: model.slope.shape[1]]), record, np.arange(samples) / RATE)
    second = SecondOrder(model, car(name).quadratic_forms, model.matrices.viscous)
    spectra = state_spectra(model, np.fft.rfft(inputs, axis=1), 1.0 / RATE, samples)
    state = np.fft.irfft(spectra, samples, axis=1)
    found = dict(zip(second.channels, second.response(second.forms.projection @ state, 1.0 / RATE), strict=True))
    names = [channel for channel in expected if channel.startswith(("knuckle", "seat", "body"))]
    # In share of the whole acceleration: y has little of it.
    shares = [
        float(np.std(found[channel] - expected[channel]) / np.std(motion_of(name, channel, motion) + expected[channel]))
        for channel in names
    ]
    validated(
        "Reduced engine",
        f"{name}: second order of knuckles, seat and body from patterns, largest difference in share of the channel",
        max(shares), 0.0,
        source="second derivation: equations of motion at each sample, dynamic stiffness at each line", abs=0.005,
    )  # fmt: skip
    assert max(float(np.std(expected[channel]) / np.std(motion_of(name, channel, motion))) for channel in names) > 0.2


def test_third_order_is_not_taken_for_second(monkeypatch: pytest.MonkeyPatch) -> None:
    """With patterns of 1 mm the vertical tyre forces, which have little of second order, were off by 4 %."""
    whole = Car.load("focus_road")
    coordinates, found = np.zeros((0, 0)), list[Vector]()
    for scale in (1.0, 2.0):
        monkeypatch.setattr(forms_module, "AMPLITUDE", scale * forms_module.AMPLITUDE)
        second = SecondOrder(
            whole.poles, forms_module.quadratic_forms(whole.model, whole.poles), whole.matrices.viscous
        )
        if not coordinates.size:
            coordinates = np.random.Generator(np.random.PCG64(1)).standard_normal((len(second.forms.projection), 400))
        response = second.response(coordinates, 3e-3)
        found.append(response[[second.channels.index(f"tyre_{wheel}_force_z") for wheel in whole.vehicle.wheels]])
    errors = np.std(found[1] - found[0], axis=1) / np.std(found[0], axis=1)
    validated(
        "Reduced engine",
        "second order of the vertical tyre forces with patterns of twice the size, largest difference in share of it",
        float(np.max(errors)), 0.0, source="closed form: the second order does not depend on the size of the patterns",
        abs=0.01,
    )  # fmt: skip


def motion_of(name: str, channel: str, motion: Motion) -> Vector:
    """Return the linear acceleration of a channel of a car."""
    row = car(name).matrices.system.outputs[channel][: motion.acceleration.shape[0]]
    return np.asarray(row @ motion.acceleration)
