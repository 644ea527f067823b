"""The body of a car without a wireframe: an outline from its own numbers, which moves with it."""

import tracemalloc
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vehicle.drawing.rendering.body_outline import CLASSES, body_class, body_outline, drawn_body
from vehicle.drawing.rendering.stage import shapes_of, stage_model
from vehicle.drawing.rendering.wireframe import GROUPS, car_wireframe
from vehicle.runs.car import Car
from vehicle.signals.analysis.thinned_wireframe import MOST_NODES


@pytest.fixture(scope="module")
def sedan():
    return Car.load("sedan").model


def test_the_outline_is_as_large_as_the_car(sedan):
    body, wheels = drawn_body(sedan), sedan.vehicle.composition.wheels
    low, high = body.points.min(axis=0), body.points.max(axis=0)
    first, last = (limit(wheel.center[0] for wheel in wheels) for limit in (min, max))
    assert low[0] == pytest.approx(0.0) and high[0] == pytest.approx(last + 0.4 * (last - first))
    assert high[1] == -low[1] > max(wheel.center[1] for wheel in wheels)
    assert high[2] == pytest.approx(sedan.vehicle.points["roof_left_rear"][2]) and low[2] > wheels[0].patch[2]
    # No line of the body crosses a tyre at its middle plane.
    for wheel in wheels:
        radius = wheel.center[2] - wheel.patch[2]
        side = body.points[np.sign(body.points[:, 1]) == np.sign(wheel.center[1])]
        assert np.linalg.norm(side[:, [0, 2]] - np.array(wheel.center)[[0, 2]], axis=1).min() > radius


def test_a_large_body_without_edges_needs_little_memory(sedan):
    """One table of distances of its points and nodes would take 20 times as much."""
    positions = np.random.default_rng(1).uniform(-1.0, 5.0, (40000, 3))
    element = SimpleNamespace(positions=positions, shapes=positions[None], edges=())
    body: Any = SimpleNamespace(superelement=element, vehicle=sedan.vehicle)
    tracemalloc.start()
    drawn = drawn_body(body)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 8 * len(positions) * len(drawn.points) / 20
    for point, nearest in zip(drawn.points, drawn.shapes[0], strict=True):
        np.testing.assert_array_equal(nearest, positions[np.linalg.norm(positions - point, axis=1).argmin()])
    one_wheel = SimpleNamespace(wheels=sedan.vehicle.composition.wheels[:1], connections=())
    body.vehicle = SimpleNamespace(composition=one_wheel)  # a rig without two axles has no outline
    shown = drawn_body(body)
    assert len(shown.points) == shown.shapes.shape[1] == MOST_NODES and not len(shown.lines)


def test_heave_and_pitch_move_the_outline_as_a_rigid_body(sedan):
    wire, body = car_wireframe(sedan), drawn_body(sedan)
    count = len(body.points)
    np.testing.assert_array_equal(wire.points[:count], body.points)
    assert (wire.groups == GROUPS.index("body")).sum() == len(body.lines) > 50
    rows, motion = wire.motion[:count], np.random.default_rng(1).normal(size=wire.motion.shape[2])
    moved = rows @ motion
    # u = u0 + theta x r: six numbers explain the motion of all points.
    x, y, z = (body.points - body.points.mean(axis=0)).T
    zero, one = np.zeros(count), np.ones(count)
    rigid = np.stack([np.stack(axis, axis=1) for axis in
                      ((one, zero, zero, zero, z, -y), (zero, one, zero, -z, zero, x), (zero, zero, one, y, -x, zero))],
                     axis=1)  # fmt: skip
    found, *_ = np.linalg.lstsq(rigid.reshape(-1, 6), moved.ravel(), rcond=None)
    np.testing.assert_allclose(rigid.reshape(-1, 6) @ found, moved.ravel(), atol=1e-9)
    assert np.ptp(moved[:, 2]) > 0.1


@pytest.mark.parametrize(
    ("name", "height", "expected"),
    [
        ("mine", 1.40, "sedan"),
        ("mine", 1.55, "hatchback"),
        ("mine", 1.68, "suv"),
        ("advanced", 2.0, "van"),
        ("my_suv", 1.40, "suv"),
        ("van 3", 1.40, "van"),
    ],
)
def test_the_class_is_that_of_the_name_or_of_the_height(name, height, expected):
    vehicle: Any = SimpleNamespace(name=name)
    assert body_class(vehicle, height, 2.75) == expected


@pytest.mark.parametrize("name", CLASSES)
def test_each_class_has_a_closed_outline(sedan, name):
    sheets, lines = body_outline(replace(sedan.vehicle, name=name))
    ends = sheets.reshape(-1, 3)[lines]
    points, counts = np.unique(ends.reshape(-1, 3), axis=0, return_counts=True)
    assert len(points) > 50 and counts.min() >= 2  # no line ends in the air
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).min() > 0.0
    lower, waist, roof = sheets[:, :3, 2].T
    assert (lower < waist).all() and (waist <= roof).all()


def test_the_picture_has_the_outline_in_place_of_the_estate_car(sedan, car):
    shell = shapes_of(sedan, rig=True)["body_shell"]
    np.testing.assert_allclose(shell.mesh.bounds, [p(drawn_body(sedan).points, axis=0) for p in (np.min, np.max)])
    assert shell.part == "body" and "body_glass" not in shapes_of(sedan, rig=True)
    assert stage_model(sedan, (320, 180)).mat("frame_at_rest").rgba[3] == 1.0
    assert "body_glass" in shapes_of(car, rig=True)
