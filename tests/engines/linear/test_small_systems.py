"""Modes and frequency responses of matrices small enough to be known in closed form."""

import numpy as np
import pytest

from tests.engines.linear.plain_matrices import plain_matrices
from tests.validation import validated
from vehicle.engines.linear import response
from vehicle.engines.linear.car_modes import car_modes
from vehicle.engines.linear.first_order import first_order, free_basis
from vehicle.engines.linear.part_motions import group_of
from vehicle.engines.linear.response import frequency_response
from vehicle.errors import ConfigurationError

SPRUNG, UNSPRUNG, SUSPENSION, TYRE = 180.0, 45.0, 3e4, 2.5e5  # the quarter car of Bommer 2006
VISCOUS, TYRE_DAMPING = 1500.0, 400.0


def quarter_car(*, branch=(), tyre_damping=0.0, links=()):
    """Coordinates: wheel, and stroke of the damper (body less wheel), as in the model of the car."""
    # u = (wheel, stroke); body = wheel + stroke.
    rows = {"body": np.array([1.0, 1.0]), "tyre_fr": np.array([1.0, 0.0])}
    masses = {"body": SPRUNG, "tyre_fr": UNSPRUNG}
    mass = np.sum([masses[name] * np.outer(row, row) for name, row in rows.items()], axis=0)
    six = {name: np.vstack([np.zeros((2, 2)), row, np.zeros((3, 2))]) for name, row in rows.items()}
    return plain_matrices(
        mass=mass, damping=np.diag([tyre_damping, 0.0]), stiffness=np.diag([TYRE, SUSPENSION]), constraints=links,
        dampers=np.array([1]), viscous=np.array([VISCOUS]), branches=[[0.0, 1.0]] * len(branch),
        branch_stiffness=[stiffness for stiffness, _ in branch], branch_time=[time for _, time in branch],
        plate_stiffness=np.array([[TYRE, 0.0], [0.0, 0.0]]), plate_damping=np.array([[tyre_damping, 0.0], [0.0, 0.0]]),
        tyre_stiffness=np.array([TYRE, TYRE]), tyre_damping=np.array([tyre_damping, tyre_damping]),
        outputs={"body_acc_z": rows["body"], "wheel_acc_z": rows["tyre_fr"]}, body_rows=six,
        body_masses={name: np.diag([value] * 3 + [1.0] * 3) for name, value in masses.items()},
    )  # fmt: skip


def test_stuck_is_one_mass_on_the_tyre():
    (mode,) = car_modes(quarter_car(tyre_damping=TYRE_DAMPING), stuck=True)
    omega = np.sqrt(TYRE / (SPRUNG + UNSPRUNG))
    validated(
        "Linear system", "frequency of a stuck quarter car", mode.frequency, omega / (2.0 * np.pi), rel=1e-12,
        unit="Hz", source="closed form: sqrt(k / m)",
    )  # fmt: skip
    validated(
        "Linear system", "damping ratio of a stuck quarter car", mode.damping_ratio,
        TYRE_DAMPING / (2.0 * omega * (SPRUNG + UNSPRUNG)), rel=1e-12, source="closed form: c / (2 sqrt(k m))",
    )  # fmt: skip
    # Locked: shares of the kinetic energy are those of the masses.
    assert mode.energy["body"] == pytest.approx(SPRUNG / (SPRUNG + UNSPRUNG), rel=1e-12)
    assert mode.description == "body heave (z)"


def test_sliding_has_the_roots_of_the_characteristic_polynomial():
    matrices = quarter_car(tyre_damping=TYRE_DAMPING)
    modes = car_modes(matrices, stuck=False)
    # (ms s2 + c s + k)(mu s2 + (c + ct) s + k + kt) - (c s + k)^2 = 0, by hand.
    c, k, ct, kt = VISCOUS, SUSPENSION, TYRE_DAMPING, TYRE
    polynomial = np.polysub(np.polymul([SPRUNG, c, k], [UNSPRUNG, c + ct, k + kt]), np.polymul([c, k], [c, k]))
    roots = np.roots(polynomial)
    exact = sorted((abs(root) / (2.0 * np.pi), -root.real / abs(root)) for root in roots if root.imag > 0.0)
    assert len(modes) == len(exact) == 2
    for mode, (frequency, ratio) in zip(modes, exact, strict=True):
        roots_of = "closed form: roots of the characteristic polynomial"
        validated(
            "Linear system", f"frequency of a sliding quarter car, {mode.description}", mode.frequency, frequency,
            rel=1e-10, unit="Hz", source=roots_of,
        )  # fmt: skip
        validated(
            "Linear system", f"damping ratio of a sliding quarter car, {mode.description}", mode.damping_ratio, ratio,
            rel=1e-9, source=roots_of,
        )  # fmt: skip
        assert sum(mode.energy.values()) == pytest.approx(1.0, rel=1e-12)
    assert modes[1].description == "right front wheel hop"
    assert (
        car_modes(matrices, stuck=False, highest=5.0) == [] or len(car_modes(matrices, stuck=False, highest=5.0)) == 1
    )


def test_a_maxwell_branch_adds_a_real_pole_and_the_right_limits():
    soft = quarter_car(branch=((7e5, 1e-9),))
    matrix = first_order(soft.system).state
    assert matrix.shape == (5, 5)
    poles = np.linalg.eigvals(matrix)
    assert np.sum(np.abs(poles.imag) < 1e-6) == 1 and poles.real.max() < 0.0
    # A fast branch is a damper K2 tau = 7e-4 N s/m, hence zero; a slow one is a spring parallel to the main one.
    plain = [mode.frequency for mode in car_modes(quarter_car(), stuck=False)]
    assert [mode.frequency for mode in car_modes(soft, stuck=False)] == pytest.approx(plain, rel=1e-6)
    slow = car_modes(quarter_car(branch=((7e5, 1e6),)), stuck=False, highest=1e3)
    hand = np.roots(
        np.polysub(
            np.polymul([SPRUNG, VISCOUS, SUSPENSION + 7e5], [UNSPRUNG, VISCOUS, SUSPENSION + 7e5 + TYRE]),
            np.polymul([VISCOUS, SUSPENSION + 7e5], [VISCOUS, SUSPENSION + 7e5]),
        )
    )
    exact = sorted(abs(root) / (2.0 * np.pi) for root in hand if root.imag > 0.0)
    validated(
        "Linear system", "frequencies of a quarter car with a slow Maxwell branch",
        np.array([mode.frequency for mode in slow]), np.array(exact), rel=1e-6, unit="Hz",
        source="closed form: the branch is a spring in parallel",
    )  # fmt: skip


def test_constraints_are_eliminated():
    # wheel = 0.5 * stroke, given twice: one motion is left, the double row takes nothing more.
    matrices = quarter_car(links=((1.0, -0.5), (2.0, -1.0)))
    basis = free_basis(matrices.system)
    assert basis.shape == (2, 1)
    np.testing.assert_allclose(matrices.system.constraints @ basis, 0.0, atol=1e-14)
    np.testing.assert_allclose(basis.T @ basis, 1.0)
    assert free_basis(quarter_car().system).shape == (2, 2)
    assert free_basis(quarter_car().system, stuck=True).shape == (2, 1)


@pytest.mark.parametrize("stuck", [True, False])
def test_frequency_response_by_hand(stuck):
    frequency = np.array([0.5, 3.0, 12.0, 40.0])
    s = 2j * np.pi * frequency
    form = first_order(quarter_car(tyre_damping=TYRE_DAMPING).system, stuck=stuck)
    outputs = ["body_acc_z", "wheel_acc_z"]
    response_by_poles = frequency_response(form, frequency, outputs, "acceleration", driven=[1.0, 0.0])
    drive = TYRE + TYRE_DAMPING * s
    if stuck:
        body = wheel = drive / ((SPRUNG + UNSPRUNG) * s**2 + drive)
    else:
        strut = SUSPENSION + VISCOUS * s
        sprung = SPRUNG * s**2 + strut
        wheel = drive / (UNSPRUNG * s**2 + strut + drive - strut**2 / sprung)
        body = wheel * strut / sprung
    validated(
        "Linear system", f"FRF of body and wheel of a {'stuck' if stuck else 'sliding'} quarter car", response_by_poles,
        np.array([s**2 * body, s**2 * wheel]), rel=1e-10, unit="(m/s2)/m", source="closed form: transfer function",
    )  # fmt: skip
    # The left plate drives nothing here.
    assert not frequency_response(form, frequency, outputs, "acceleration", driven=[0.0, 1.0]).any()


def test_unknown_channel():
    with pytest.raises(ConfigurationError) as caught:
        frequency_response(first_order(quarter_car().system), [1.0], ["roof_acc_z"])
    assert str(caught.value) == "output 'roof_acc_z': unknown; choose from body_acc_z, wheel_acc_z"


def test_groups_of_parts(car):
    names = ("body", "engine", "main_spring_upper_fr", "stabilizer_rod_fl", "tyre_fl")
    assert [group_of(car.matrices, name) for name in names] == ["body", "engine", "body", "stabilizer", "wheel_fl"]


def test_newtons_beside_metres_are_no_dependent_vectors(monkeypatch):
    # The force of a stiff Maxwell branch is a state; by the poles all the same, not line by line. In metres and newtons
    # the reciprocal condition is 2e-6 here, and 7e-9 in a whole car.
    monkeypatch.setattr(response, "DEFECTIVE", 1e-4)
    stiffness, time = 1e9, 1e-3
    system = quarter_car(branch=[(stiffness, time)]).system
    by_lines: list[object] = []
    monkeypatch.setattr(response, "_solved", lambda *arguments: by_lines.append(arguments))
    lines = np.array([1.0, 10.0, 40.0])
    response_by_poles = frequency_response(first_order(system), lines, "body_acc_z", driven=[1.0, 0.0])
    assert not by_lines
    for line, ours in zip(2j * np.pi * lines, response_by_poles, strict=True):
        damper = line * (VISCOUS + stiffness * time / (1.0 + line * time))
        dynamic = line**2 * system.mass + np.diag([TYRE, SUSPENSION + damper])
        validated(
            "Linear system", f"FRF with a stiff Maxwell branch at {line.imag / (2.0 * np.pi):g} Hz", ours,
            np.linalg.solve(dynamic, [TYRE, 0.0]).sum(), rel=1e-9, unit="m/m",
            source="closed form: dynamic stiffness at the line",
        )  # fmt: skip
