"""Decoupling of the engine on its mounts: own six-degree code, energy of the modes of the car, torque roll axis."""

import json
from typing import Any

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle import Car
from vehicle.commands.modes import main
from vehicle.engines.linear.decoupling import MOTIONS, decoupling
from vehicle.errors import ConfigurationError


def cross(arm: np.ndarray) -> np.ndarray:
    x, y, z = arm
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def own_code(car: Any) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness of the engine and its torque arm over both motions, from the vehicle file alone; (12, 12)."""
    parts = {part.name: part for part in car.vehicle.composition.parts}
    hung = [parts["engine"], parts["torque_arm"]]
    masses = []
    for part in hung:
        xy, zx, yz = part.numbers.products
        inertia = np.diag(part.numbers.inertia) - np.array([[0, xy, zx], [xy, 0, yz], [zx, yz, 0]])
        masses += [part.numbers.mass * np.eye(3), inertia]
    stiffness, names = np.zeros((12, 12)), [part.name for part in hung]
    for mount in car.vehicle.composition.connections:
        rows, turns = np.zeros((3, 12)), np.zeros((3, 12))
        for name, sign in ((mount.moving, 1.0), (mount.carrier, -1.0)):
            if name in names:
                first = 6 * names.index(name)
                arm = np.array(mount.at) - np.array(parts[name].cog)
                rows[:, first : first + 6] += sign * np.hstack([np.eye(3), -cross(arm)])
                turns[:, first + 3 : first + 6] += sign * np.eye(3)
        if rows.any():
            stiffness += rows.T @ np.diag(mount.law.stiffness) @ rows
            stiffness += mount.law.rotational_stiffness * turns.T @ turns
    return scipy.linalg.block_diag(*masses), stiffness


def test_grounded_modes_are_those_of_an_own_code() -> None:
    # Weightless: preloads have a geometric stiffness, which the own code leaves out.
    changes = {"gravity": 0.0, "engine.parts.engine.products": [1.2, -0.8, 0.5]}
    car = Car.load("sedan", changes)
    mass, stiffness = own_code(car)
    squares, shapes = scipy.linalg.eigh(stiffness, mass)
    found = decoupling(car.matrices, "engine", grounded=True, crankshaft=(0.1, 1.0, 0.05))
    assert len(found.modes) == 6
    validated(
        "Applied forces",
        "decoupling, engine and torque arm of the sedan on their mounts, body fixed: squared natural frequencies",
        np.array([(2.0 * np.pi * mode.frequency) ** 2 for mode in found.modes]), squares[:6],
        source="second derivation: twelve degrees of freedom from points, stiffnesses and inertia of the vehicle file",
        rel=1e-7, unit="1/s2",
    )  # fmt: skip
    for mode, shape in zip(found.modes, shapes.T[:6], strict=True):
        table = shape[:6, None] * mass[:6, :6] * shape[None, :6]
        assert mode.table == pytest.approx(table / table.sum(), abs=1e-7)
        assert mode.shares.sum() == pytest.approx(1.0, abs=1e-12)
        assert mode.energy == pytest.approx(table.sum(), rel=1e-7)
    condensed = stiffness[:6, :6] - stiffness[:6, 6:] @ np.linalg.solve(stiffness[6:, 6:], stiffness[6:, :6])
    shaft = np.array([0.1, 1.0, 0.05]) / np.linalg.norm([0.1, 1.0, 0.05])
    axis = np.linalg.solve(mass[3:6, 3:6], shaft)
    turn = np.concatenate([np.zeros(3), axis / np.linalg.norm(axis)])
    square = turn @ condensed @ turn / (turn @ mass[:6, :6] @ turn)
    missed = np.linalg.solve(mass[:6, :6], condensed @ turn) - square * turn
    assert found.roll_axis == pytest.approx(turn[3:], abs=1e-9)
    assert (2.0 * np.pi * found.roll_frequency) ** 2 == pytest.approx(square, rel=1e-6)
    assert found.residual == pytest.approx(np.linalg.norm(missed) / square, rel=1e-5)


def test_modes_of_the_car_share_their_energy_with_the_engine() -> None:
    car = Car.load("sedan")
    modes = {round(mode.frequency, 6): mode for mode in car.modes("stuck")}
    found = decoupling(car.matrices, "engine")
    assert found.modes
    for mode in found.modes:
        assert mode.energy == pytest.approx(modes[round(mode.frequency, 6)].energy["engine"], rel=1e-9)
        assert mode.shares.sum() == pytest.approx(1.0, abs=1e-9)
    assert len(MOTIONS) == 6


def test_a_part_that_is_not_free_is_refused() -> None:
    matrices = Car.load("sedan").matrices
    with pytest.raises(ConfigurationError, match=r"part 'engin': unknown; choose from a_arm_fl, .* engine"):
        decoupling(matrices, "engin")
    with pytest.raises(ConfigurationError, match="is held by joints or wheels"):
        decoupling(matrices, "knuckle_fr")
    with pytest.raises(ConfigurationError, match="must be a direction"):
        decoupling(matrices, "engine", crankshaft=(0.0, 0.0, 0.0))


def test_the_command_prints_what_the_matrices_say(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--vehicle", "sedan", "--decoupling", "engine", "--grounded", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    expected = decoupling(Car.load("sedan").matrices, "engine", grounded=True)
    assert [mode["frequency_hz"] for mode in printed["modes"]] == [mode.frequency for mode in expected.modes]
    assert main(["--vehicle", "sedan", "--decoupling", "engine", "--grounded", "--aim", "85"]) == 0
    rows = capsys.readouterr().out.splitlines()[2:8]
    below = ["below 85" in row for row in rows]
    assert below == [100.0 * mode.shares.max() < 85.0 for mode in expected.modes]
    assert {True, False} == set(below)
    for wrong in ("--grounded", "--decoupling engine --aim 0", "--decoupling engine --crankshaft y"):
        assert main(["--vehicle", "sedan", *wrong.split()]) == 2
