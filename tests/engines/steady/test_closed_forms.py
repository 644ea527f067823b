"""The splitting on systems that are known in closed form: Den Hartog, Caughey, linear limits, energy."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.engines.linear.plain_matrices import plain_matrices
from tests.engines.reduced.test_reduced_quarter_car import damper, matrices
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.steady.car_ports import car_ports
from vehicle.engines.steady.channel_rows import channel_rows
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.law_ports import Play
from vehicle.engines.steady.level_states import level_states
from vehicle.engines.steady.plant import Plant
from vehicle.engines.steady.splitting import periodic_forces

NO_LOADS: Any = SimpleNamespace(names=())
STIFFNESS, MASS = 2e4, 50.0


def states(model, dampers, frequency, level, channels, **more):
    return level_states(
        model, dampers, tyre_load={"fr": 1e6, "fl": 1e6}, loads=NO_LOADS,
        shares=np.tile([1.0, 0.0], (np.size(frequency), 1)), frequency=np.atleast_1d(frequency),
        level=np.atleast_1d(level), channels=channels, **more,
    )  # fmt: skip


def oscillator(damping=0.0):
    """A mass on a spring over the right plate, rubbing on the ground; the damper is its coordinate."""
    row = np.array([[STIFFNESS], [0.0]])
    return pole_model(
        plain_matrices(
            mass=np.array([[MASS]]), damping=np.array([[damping]]), stiffness=np.array([[STIFFNESS]]),
            dampers=np.array([0]), viscous=np.zeros(1), plate_stiffness=row, plate_damping=0.0 * row,
            tyre_stiffness=np.full(2, STIFFNESS), tyre_damping=np.zeros(2), outputs={"knuckle_fr_acc_z": np.ones(1)},
            body_rows={"body": np.zeros((6, 1))}, body_masses={"body": np.eye(6)},
        )
    )  # fmt: skip


@pytest.mark.parametrize(("ratio", "samples"), [(0.6, 2048), (0.8, 2048), (1.3, 2048), (2.0, 8192)])
def test_den_hartog(ratio, samples):
    """Largest displacement of forced motion with Coulomb friction and no stops, w/w_n = ratio."""
    share, level = 0.3, 1e-3
    law = damper(viscous=0.0, coulomb_friction=share * STIFFNESS * level, smoothing=1e8)
    model = oscillator()
    ports, cycle = car_ports(model, [law]), Cycle(samples, True)
    plant = Plant(model, ports.moved, channel_rows(model, [], NO_LOADS))
    speed = ratio * np.sqrt(STIFFNESS / MASS)
    table = plant.responses(speed * cycle.harmonics)
    drive = np.zeros((1, 1, len(cycle.harmonics)), dtype=complex)
    drive[0, 0, 0] = level * table.inputs[0, 0, 0]
    scaling = ports.ports[0].scaling(np.abs(table.forces[:1, 0, 0]))[None]
    found = periodic_forces(ports.ports, cycle, table.forces[None], drive, scaling, tolerance=1e-5)
    assert found.ended.all()
    velocity = drive[0, 0] - table.forces[0, 0] * cycle.amplitudes(found.force)[0, 0]
    displacement = cycle.histories(velocity / (1j * speed * cycle.harmonics))
    v, h = 1.0 / (1.0 - ratio**2), np.sin(np.pi / ratio) / (ratio * (1.0 + np.cos(np.pi / ratio)))
    # The force jumps at the turning points, and a sample does not see when: the error falls as 1/n.
    validated(
        "Dampers and friction", f"largest displacement of an oscillator with Coulomb friction at {ratio:g} w_n",
        1e3 * np.max(np.abs(displacement)), 1e3 * level * np.sqrt(v**2 - (share * h) ** 2), rel=5e-4, unit="mm",
        source="closed form: Den Hartog, Trans. ASME 53 (1931), APM-53-9, motion without stops",
    )  # fmt: skip


@pytest.mark.parametrize("upper", [True, False])
@pytest.mark.parametrize("ratio", [1.5, 6.0, 20.0])
def test_caughey(ratio, upper):
    """Bilinear hysteresis, k1 x and one Jenkins element, on both sides of the resonance.

    With the amplitude A, cos(t) = 1 - 2 x_y/A, C = A k2 (t - sin(2 t)/2)/pi and S = A k2 sin(t)^2/pi, averaging gives
    ((k1 - m w^2) A + C)^2 + S^2 = F^2. It is exact to the order (k2/k1)^2: higher harmonics of x are k2/(8 k1).
    """
    hysteresis, yielding = 0.01 * STIFFNESS, 1e-3
    amplitude = ratio * yielding
    turn = np.arccos(1.0 - 2.0 / ratio)
    spring = hysteresis * (turn - 0.5 * np.sin(2.0 * turn)) / np.pi
    loss = amplitude * hysteresis * np.sin(turn) ** 2 / np.pi
    force, side = 1.3 * loss, "above" if upper else "below"
    beside = np.sqrt(force**2 - loss**2) / amplitude * (1.0 if upper else -1.0)
    speed = np.sqrt((STIFFNESS + spring + beside) / MASS)
    cycle = Cycle(512, True)
    port = Play(base=0, of_velocity=False, share=0.5, stiffness=np.array([hysteresis]), stroke=np.array([yielding]))
    effect = 1.0 / (STIFFNESS - MASS * (speed * cycle.harmonics) ** 2)
    drive = np.zeros((1, 1, len(cycle.harmonics)), dtype=complex)
    drive[0, 0, 0] = force * effect[0]
    scaling = port.scaling(np.abs(effect[:1]))[None]
    found = periodic_forces([port], cycle, effect[None, None, None] + 0j, drive, scaling)
    assert found.ended.all()
    displacement = drive[0, 0] - effect * cycle.amplitudes(found.force)[0, 0]
    validated(
        "Dampers and friction",
        f"amplitude of an oscillator with bilinear hysteresis over its yield {side} its resonance, {ratio:g}",
        np.abs(displacement[0]) / yielding, ratio, rel=2e-4,
        source="closed form: Caughey, J. Appl. Mech. 27 (1960) 640, averaging",
    )  # fmt: skip


@pytest.mark.parametrize("stuck", [True, False])
def test_linear_limits(stuck):
    """A small level, and almost no friction: the matrices with stuck or with sliding dampers."""
    friction = {"smoothing": 1e8} if stuck else {"coulomb_friction": 1e-9}
    frequency, level = np.array([1.5, 4.0, 9.0, 14.0]), 1e-8 if stuck else 1e-2
    names = ["knuckle_fr_acc_z", "suspension_mount_fr_acc_z"]
    found = states(pole_model(matrices(40.0)), [damper(**friction)] * 2, frequency, level, names)
    form = first_order(matrices(40.0).system, stuck=stuck)
    expected = frequency_response(form, frequency, names, "acceleration", driven=[1.0, 0.0])
    validated(
        "Reduced engine", f"FRF of a quarter car in its periodic state, dampers {'stuck' if stuck else 'sliding'}",
        np.ravel(found.frf[..., 0]), np.ravel(expected), peak=1e-4 if stuck else 1e-6, unit="m/s2 per m",
        source="second derivation: linear FRF from the matrices",
    )  # fmt: skip
    # The friction line is not rigid, but 2/pi 1e8 s/m times the limit: a stuck damper moves by 1e-5 of the plate.
    assert np.all(found.distortion < 1e-6)


def test_the_dampers_take_the_energy_of_the_plate():
    """The plate works by the force of the tyre; without other damping all of it goes into the damper."""
    frequency, level = np.array([1.2, 3.0, 8.0, 11.0]), np.array([1e-4, 1e-3, 4e-3])
    found = states(pole_model(matrices()), [damper()] * 2, frequency, level, ["tyre_fr_force_z"])
    assert found.ended.all() and 0.0 < found.slip[0, -1, -1] < 1.0
    # z = h cos(w t), F = Re(h H exp(j w t)) on the wheel: the plate works the integral of F z' = pi h^2 Im H.
    work = np.pi * level**2 * found.frf[0].imag
    validated(
        "Reduced engine", "energy of the damper of a quarter car over the work of its plate, in the periodic state",
        found.energy[0], work, rel=1e-5, abs=1e-9, unit="J", source="conservation: energy of a period",
    )  # fmt: skip
    assert np.allclose(found.energy[1], 0.0)


def test_the_first_damper_slips_at_the_level_of_the_closed_form():
    model, law = pole_model(matrices()), damper()
    frequency = np.array([1.2, 3.0, 8.0, 11.0])
    first = states(model, [law] * 2, frequency, 1e-3, ["knuckle_fr_acc_z"]).first[0]
    for at, level in zip(frequency, first, strict=True):
        found = states(model, [law] * 2, at, level * np.array([0.999, 1.001]), ["knuckle_fr_acc_z"])
        # The samples may miss the top of a sine by 1 - cos(pi/128).
        assert found.effort[0, 0, 0] == pytest.approx(0.999, rel=3.1e-4)
        assert found.slip[0, 0].tolist()[0] == 0.0 and found.effort[0, 0, 1] > 1.0


def test_more_samples_change_little():
    """The force of friction jumps: its harmonics fall as 1/k, those of the response of the car faster."""
    model, frequency, level = pole_model(matrices(40.0)), np.array([1.5, 4.0, 9.0]), np.array([5e-4, 3e-3])
    coarse, fine = (
        states(model, [damper()] * 2, frequency, level, ["suspension_mount_fr_acc_z"], samples=samples).frf
        for samples in (128, 1024)
    )
    assert np.max(np.abs(coarse / fine - 1.0)) < 1e-3


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_only_one_state_is_proven_of_friction_that_falls_less_than_the_damping(share):
    """Of an oscillator Re(1/G) is its damping constant; the friction falls by at most (Fs - Fd)/vs."""
    law = damper(
        viscous=0.0, friction_law="stribeck", coulomb_friction=5.0, stribeck_friction=9.0, smoothing=1e7,
        stribeck_velocity=4.0 / (share * 300.0), stribeck_exponent=1.0,
    )  # fmt: skip
    found = states(oscillator(damping=300.0), [law], [2.0, 5.0], 1e-3, ["knuckle_fr_acc_z"])
    assert found.unique.tolist() == 2 * [share < 1.0]
