"""Axles of Chrono against an independent solution of their loops, from the points in the JSON files.

Six unknowns of the upright (translation, rotation vector) and six equations: each ball joint keeps its distances from
the two joints of its arm, the tie rod its length, the top of a strut stays on its axis, and the wheel centre has its
height. Solved by Newton's method in Chrono's frame on the left side; the project solves it in coordinates of joints.
"""

import numpy as np
import pytest

from tests.chrono_files import FILES, write_chrono
from tests.validation import validated
from vehicle.runs.car.axle import axle_statics
from vehicle.studies.design.chrono_car import chrono_car

CARS = {"wishbone_car": ("wishbones", "wishbones"), "strut_car": ("strut", "wishbones")}
TRAVEL = (-0.08, -0.05, -0.02, 0.0, 0.03, 0.06, 0.09)
SOURCE = "second derivation: Newton's method on the loop equations of the JSON file"
TO_VEHICLE = np.diag([-1.0, 1.0, 1.0])


@pytest.fixture(scope="module", params=CARS)
def imported(request, tmp_path_factory):
    folder = write_chrono(tmp_path_factory.mktemp("chrono"))
    return request.param, chrono_car("small", folder / f"{request.param}.json", folder / "tmeasy.json").car


def turned(vector):
    """Return the matrix of a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def gaps(state, file, travel):
    """Return the six residuals of the loops of the left wheel [m]."""

    def p(part, name):
        return np.array(file[part][name], dtype=float)

    centre = p("Spindle", "COM")
    shift, turn = state[:3], turned(state[3:])

    def moved(point):
        return centre + shift + turn @ (point - centre)

    def stretch(point, anchor):
        return np.linalg.norm(moved(point) - anchor) - np.linalg.norm(point - anchor)

    arms = ["Upper Control Arm", "Lower Control Arm"] if "Upper Control Arm" in file else ["Control Arm"]
    residuals = [
        stretch(p(arm, "Location Upright"), p(arm, f"Location Chassis {end}"))
        for arm in arms
        for end in ("Front", "Back")
    ]
    residuals.append(stretch(p("Tierod", "Location Upright"), p("Tierod", "Location Chassis")))
    if "Strut" in file:
        top, low = p("Spring", "Location Chassis"), p("Spring", "Location Upright")
        # The axis goes with the upright; the top is fixed to the chassis.
        along = turn @ (top - low) / np.linalg.norm(top - low)
        off = top - moved(low)
        first = np.cross(along, [0.0, 1.0, 0.0])
        residuals += [off @ first, off @ np.cross(along, first)]
    return np.array([*residuals, shift[2] - travel])


def solution(file, travel):
    """Return displacement of the wheel centre [m] and rotation of the upright at a wheel travel."""
    state, h = np.zeros(6), 1e-6
    state[2] = travel
    for _ in range(50):
        residual = gaps(state, file, travel)
        if np.max(np.abs(residual)) < 1e-14:
            break
        columns = [(gaps(state + e, file, travel) - gaps(state - e, file, travel)) / (2 * h) for e in h * np.eye(6)]
        state = state - np.linalg.solve(np.column_stack(columns), residual)
    assert np.max(np.abs(residual)) < 1e-12
    return state[:3], turned(state[3:])


def test_hardpoints_of_the_assembled_car_are_those_of_the_files(imported):
    name, car = imported
    vehicle = FILES[name]
    points = car.vehicle.points
    shift: np.ndarray | None = None
    for axle, place, file in zip(("front", "rear"), vehicle["Axles"], CARS[name], strict=True):
        suspension, side = FILES[file], "fr" if axle == "front" else "rr"
        arms = {"lower_ball": ("Lower Control Arm", "Location Upright"),
                "upper_ball": ("Upper Control Arm", "Location Upright"),
                "lower_front": ("Lower Control Arm", "Location Chassis Front"), "wheel_center": ("Spindle", "COM"),
                "spring_upper": ("Spring", "Location Chassis"), "damper_upper": ("Shock", "Location Chassis"),
                "damper_lower": ("Shock", "Location Arm"), "tie_inner": ("Tierod", "Location Chassis")}  # fmt: skip
        struts = {"lower_ball": ("Control Arm", "Location Upright"),
                  "arm_rear": ("Control Arm", "Location Chassis Back"),
                  "strut_top": ("Spring", "Location Chassis"), "damper_bottom": ("Spring", "Location Upright"),
                  "tie_outer": ("Tierod", "Location Upright"), "wheel_center": ("Spindle", "COM")}  # fmt: skip
        for point, (part, key) in (struts if file == "strut" else arms).items():
            expected = TO_VEHICLE @ (np.array(place["Suspension Location"]) + np.array(suspension[part][key]))
            here = np.array(points[f"{point}_{side}"])
            shift = here - expected if shift is None else shift
            assert here == pytest.approx(expected + shift, abs=1e-9)
            assert points[f"{point}_{side[0]}l"] == pytest.approx(here * (1.0, -1.0, 1.0), abs=1e-12)
    assert shift is not None and shift[1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("axle", ["front", "rear"])
def test_wheel_centre_camber_and_toe_over_travel(imported, axle):
    name, car = imported
    file = FILES[CARS[name][("front", "rear").index(axle)]]
    statics = axle_statics(car, axle, ideal=True)
    at_rest = statics.position().centres
    poses, solutions = [], []
    for travel in TRAVEL:
        statics.solve([travel, travel])
        place = statics.position()
        shift, turn = solution(file, travel)
        right = int(np.argmax(at_rest[:, 1]))
        poses.append([*(place.centres[right] - at_rest[right]), *place.frames[right][:, 1]])
        turn = TO_VEHICLE @ turn @ TO_VEHICLE
        solutions.append([*(TO_VEHICLE @ shift), *turn[:, 1]])
        # The left side is its mirror image.
        mirrored = (place.centres[1 - right] - at_rest[1 - right]) * (1.0, -1.0, 1.0)
        assert mirrored == pytest.approx(poses[-1][:3], abs=1e-9)
    here, expected = np.array(poses), np.array(solutions)
    assert np.ptp(expected[:, 1]) > 1e-3 and np.ptp(expected[:, 5]) > 5e-3
    kind = "strut" if "Strut" in file else "double wishbone"
    validated(
        "Suspension kinematics", f"wheel centre of an imported {kind} ({axle} of {name}), -80 to 90 mm", here[:, :3],
        expected[:, :3], abs=1e-6, unit="m", source=SOURCE,
    )  # fmt: skip
    validated(
        "Suspension kinematics", f"direction of the wheel axle of an imported {kind} ({axle} of {name})", here[:, 3:],
        expected[:, 3:], abs=1e-6, unit="rad", source=SOURCE,
    )  # fmt: skip


def test_the_rigid_bushings_keep_the_ideal_path(imported):
    _, car = imported
    ideal, loaded = (axle_statics(car, "front", ideal=word) for word in (True, False))
    for travel in (-0.05, 0.05):
        first, second = (axle.solve([travel, travel])[0] for axle in (ideal, loaded))
        assert second.lateral_m == pytest.approx(first.lateral_m, abs=2e-4)
        assert second.camber_deg == pytest.approx(first.camber_deg, abs=0.03)
