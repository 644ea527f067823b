"""Modes of the car as a universal file, and measured modes beside those of a car."""

import json

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.compare import main as compare
from vehicle.commands.inspect import main as inspect
from vehicle.commands.modes import main as modes
from vehicle.errors import DataError
from vehicle.model.parameters.paths import value_of
from vehicle.runs.car import Car
from vehicle.runs.comparison.mode_comparison import compare_modes, shapes_at
from vehicle.runs.output.mode_file import mode_shapes
from vehicle.signals.analysis.modal_assurance import mac
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.reader import read_record


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("modes") / "car.uff"
    assert modes(["--uff", str(path)]) == 0
    return path


def test_mac_by_hand():
    first = np.array([[1.0, 0.0], [1.0, 1.0j]])
    # (1, j)^H (1, 1) = 1 - j: |1 - j|^2 / (2 * 2) = 1/2.
    second = np.array([[1.0, 1.0], [2.0j, 0.0]])
    validated(
        "Linear system", "modal assurance criterion of complex shapes", mac(first, second),
        np.array([[0.5, 1.0], [0.5, 0.5]]), rel=1e-7, source="closed form: |a' b|^2 / (a' a b' b), by hand",
    )  # fmt: skip
    assert mac(first, [[0.0, 0.0]]).max() == 0.0


def test_mac_with_a_mass_matrix_does_not_depend_on_the_coordinates():
    """MAC of a equals that of T^-1 a with T^T M T, and that of L^T a without a mass matrix, M = L L^T."""
    rng = np.random.default_rng(3)
    first, second = (rng.normal(size=(4, 5)) + 1j * rng.normal(size=(4, 5)) for _ in range(2))
    root, change = np.tril(rng.normal(size=(5, 5))), rng.normal(size=(5, 5)) + 3.0 * np.eye(5)
    mass, back = root @ root.T, np.linalg.inv(change).T
    expected = mac(first @ root, second @ root)
    np.testing.assert_allclose(mac(first, second, mass), expected, rtol=1e-12)
    np.testing.assert_allclose(mac(first @ back, second @ back, change.T @ mass @ change), expected, rtol=1e-9)
    np.testing.assert_allclose(np.diag(mac(first, 2j * first, mass)), 1.0, rtol=1e-12)


def test_the_file_holds_places_and_modes(file, car, capsys):
    found, ours = read_record(file), car.modes()
    places = [one.name for one in car.vehicle.composition.outputs]
    at = [one.at for one in car.vehicle.composition.outputs]
    np.testing.assert_allclose(list(found.geometry.points.values())[: len(places)], at, atol=1e-5)
    assert [one.frequency for one in found.shapes] == pytest.approx([mode.frequency for mode in ours], rel=1e-5)
    assert [one.damping_ratio for one in found.shapes] == pytest.approx([mode.damping_ratio for mode in ours], rel=1e-4)
    assert all(one.is_complex for one in found.shapes)
    truth = shapes_at(car, ours, places).reshape(len(ours), -1)
    theirs = np.array([one.shape[:, :3] for one in found.shapes]).reshape(len(ours), -1)
    np.testing.assert_allclose(np.diag(mac(truth, theirs)), 1.0, atol=1e-9)
    assert np.max(np.abs(theirs), axis=1) == pytest.approx(1.0)
    capsys.readouterr()
    assert modes(["--uff", str(file)]) == 2 and "exists; give --force" in capsys.readouterr().err


def test_the_command_inspect_lists_modes(file, car, capsys):
    assert inspect([str(file)]) == 0
    said = capsys.readouterr().out
    assert "no channels; 14 nodes, " in said and f"{car.modes()[0].frequency:.4f}" in said and "complex  body" in said
    assert inspect([str(file), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["modes"][0]["damping_ratio"] == pytest.approx(car.modes()[0].damping_ratio, rel=1e-4)
    assert len(found["points"]) == 14 and found["modes"][0]["modal_mass"] is None


def test_pairs_and_their_frequencies(file, tmp_path, car, capsys):
    """Against the modes of the other car themselves: an engine mount 3 % stiffer."""
    path = "bushings.linear_mount.stiffness.z"
    change = f"{path}={1.03 * value_of(car.vehicle, path)!r}"
    arguments = ["--measured", str(file), "--set", change, "--output", str(tmp_path / "modes"), "--json"]
    assert compare(arguments) == 0
    content = json.loads(capsys.readouterr().out)
    other = Car.load(overrides=[change]).modes()
    assert len(content["points"]) == len(car.vehicle.composition.outputs) and (tmp_path / "modes" / "mac.png").exists()
    assert len(content["pairs"]) >= len(other) - 2
    for pair in content["pairs"][:12]:
        # The order of the low modes stays: number n of the one is number n of the other.
        assert pair["measured"] == pair["simulated"] and pair["mac"] > 0.9
        expected = other[pair["simulated"] - 1].frequency / car.modes()[pair["measured"] - 1].frequency - 1.0
        assert pair["deviation"] == pytest.approx(expected, abs=2e-5)
    assert max(abs(pair["deviation"]) for pair in content["pairs"]) > 1e-3
    np.testing.assert_allclose(np.diag(content["measured_auto_mac"]), 1.0)
    # Without figures the comparison writes its table.
    assert compare(["--measured", str(file), "--output", str(tmp_path / "plain"), "--no-figures", "--quiet"]) == 0
    assert {path.name for path in (tmp_path / "plain").iterdir()} == {"compare.json", ".vehicle-files"}


def measurement(path, car, places, **changes):
    """Modes of the car at some places, at nodes 11, 12, ... without a geometry."""
    shapes = []
    for one in mode_shapes(car)[:3]:
        rows = [one.points.index(place) for place in places]
        labels = tuple(str(11 + n) for n in range(len(places)))
        shapes.append(ModeShape(number=one.number, frequency=one.frequency, points=labels, shape=one.shape[rows]))
    return Measurement(path=path, format="uff", channels=(), shapes=tuple(shapes), **changes)


def test_nodes_are_told_or_lie_at_places(tmp_path, car):
    places = ("knuckle_fr", "knuckle_fl", "engine", "seat_rail")
    bare = measurement(tmp_path, car, places)
    with pytest.raises(DataError, match="0 nodes lie at output points of the car"):
        compare_modes(car, bare, {})
    told = compare_modes(car, bare, {place: f"Dof {11 + n}" for n, place in enumerate(places)})
    assert [pair.simulated for pair in told.pairs] == [1, 2, 3] and min(pair.mac for pair in told.pairs) > 1.0 - 1e-9
    with pytest.raises(DataError, match="no mode has a node '99'; choose from 11, 12, 13, 14"):
        compare_modes(car, bare, dict.fromkeys(places, "99"))
    # damper_top_fr and suspension_mount_fr lie at one point: one node there is neither.
    at = {one.name: one.at for one in car.vehicle.composition.outputs}
    names = (*places, "damper_top_fr")
    near = {str(11 + n): tuple(np.array(at[place]) + 0.004) for n, place in enumerate(names)}
    placed = measurement(tmp_path, car, names, geometry=Geometry(points=near))
    assert "damper_top_fr" not in compare_modes(car, placed, {}).points
