"""Errors that a run of the reduced engine states of its channels, in words and against MuJoCo."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.reduced import second_order
from vehicle.engines.reduced.linear_motion import motion_rows
from vehicle.engines.reduced.second_order import error_sentence, is_main, misses_main
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road


def test_channels_are_named_by_their_error_with_its_sign() -> None:
    errors = {"seat_acc_x": -0.031, "seat_acc_z": 0.019, "engine_acc_y": 0.12}
    (sentence,) = error_sentence(errors)
    assert sentence.endswith("by about +12 % (engine_acc_y), -3 % (seat_acc_x): use the MuJoCo engine")
    (long,) = error_sentence({f"seat_{k}_acc_x": 0.03 + 0.01 * k for k in range(7)})
    assert "+9 % (seat_6_acc_x)" in long and "and 3 more: use" in long
    assert error_sentence({"seat_acc_x": -0.019}) == ()


def test_main_channels_decide() -> None:
    main = [
        "seat_acc_x",
        "seat_rail_acc_z",
        "body_front_acc_x",
        "knuckle_fr_acc_y",
        "tyre_fl_force_z",
        "damper_rr_force",
    ]
    assert all(misses_main({channel: -0.03}) for channel in main)
    assert not misses_main({"engine_acc_x": 0.3, "seat_acc_x": 0.01})
    assert not any(is_main(channel) for channel in ("damper_top_fl_acc_x", "roof_left_rear_acc_x", "engine_acc_z"))


@pytest.mark.parametrize(
    ("name", "road"),
    [
        ("sedan", Road("half_round:29", speed=30.3)),
        ("focus_road", Road("pothole:20x300", speed=40.0)),
    ],
    ids=["sedan_lifts_off", "focus_road_pothole"],
)
def test_stated_errors_against_mujoco(name: str, road: Road) -> None:
    """Forces on slopes and of lifting tyres act along the displaced wheels, and forces that balance belong together.

    Without the first, the rear of the sedan along y was stated 15 points off where its tyres lift off; with fewer
    patterns of the motion, the front of the other car over the pothole 9 points.
    """
    car = Car.load(name)
    step = car.stepped().vehicle.solver.timestep
    assert step is not None
    whole = Car.load(name, {"solver.timestep": step / 2.0}).run(road).recording
    reduced = car.run(road, engine="reduced").recording
    errors = reduced.statistics.errors
    found = {
        channel: float(np.std(reduced[channel]) / np.std(whole[channel])) - 1.0
        for channel in errors
        if is_main(channel)
    }
    assert max(found.values()) > 0.02 and min(found.values()) < -0.02
    validated(
        "Reduced engine",
        f"{name}: stated errors of the RMS of all channels of seat and body over {road.road}, largest difference",
        max(abs(errors[channel] - found[channel]) for channel in found if channel.startswith(("seat", "body"))),
        0.0,
        source="second derivation: MuJoCo at half its step",
        abs=0.01,
    )
    validated(
        "Reduced engine",
        f"{name}: stated errors of the RMS of knuckles, dampers and tyres over {road.road}, largest difference",
        max(abs(errors[channel] - found[channel]) for channel in found),
        0.0,
        source="second derivation: MuJoCo at half its step",
        abs=0.03,
    )
    statistics = reduced.statistics
    assert (
        not statistics.within_validity
        and ("the linear geometry of the reduced engine makes the RMS wrong") in statistics.warnings[-1]
    )


def test_parts_of_a_record_state_what_the_whole_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each part continues the one before. When each began about its mean, knuckles were stated up to 6 points apart."""
    car, road = Car.load("sedan"), Road("C", speed=100.0, duration=6.0, seed=3)
    found = list[dict[str, float]]()
    for window in (30.0, 3.0):
        monkeypatch.setattr(second_order, "WINDOW", window)
        found.append(dict(car.run(road, engine="reduced").recording.statistics.errors))
    whole, parts = found
    validated(
        "Reduced engine",
        "sedan on class C: stated errors of all main channels in two parts of 3 s, largest difference from the whole",
        max(abs(parts[channel] - whole[channel]) for channel in whole if is_main(channel)),
        0.0,
        source="second derivation: the record of 6 s as a whole",
        abs=0.01,
    )


def test_an_applied_force_leaves_the_forces_of_laws_where_they_are() -> None:
    """The forces of a stop were read from the history of a torque: 1 mN m moved a stated error by 4 points."""
    stop = "front.damper.stop={displacement=[-0.03, -0.002, 0.002, 0.03], force=[-2800.0, 0.0, 0.0, 2800.0]}"
    shake = ["force.shake.on=engine", "force.shake.moment=[0, 1, 0]", "force.shake.frequency=8"]
    model = Car.load("kinematic_reference", [stop, *shake, "force.shake.harmonics=[[1, 1, 0]]"]).poles
    lines = model.applied.shape[1]
    assert model.laws and lines
    for rows, alone in zip(motion_rows(model), motion_rows(model.without_forces()), strict=True):
        assert rows[:, :-lines] == pytest.approx(alone, rel=1e-9, abs=1e-9 * np.max(np.abs(alone), initial=0.0))


def test_auto_answers_for_the_channels_that_are_asked_for() -> None:
    car, road = Car.load("sedan"), Road("half_round:15", speed=20.0)
    vertical = car.run(road, engine="auto", channels=["seat_acc_z"]).recording.statistics
    assert (vertical.engine, vertical.warnings) == ("reduced", ())
    assert list(vertical.errors) == ["seat_acc_z"] and abs(vertical.errors["seat_acc_z"]) < 0.02
    run = car.run(road, engine="auto", channels=["seat_acc_x"])
    assert run.recording.statistics.engine == "mujoco" and "-3 % (seat_acc_x)" in run.engine_reason
