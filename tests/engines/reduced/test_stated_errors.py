"""Errors that a run of the reduced engine states of its channels, in words and against MuJoCo."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.shaker import main as shaker
from vehicle.engines.reduced import reduced_run, second_order
from vehicle.engines.reduced.linear_motion import (
    continued,
    motion_rows,
    periodic_spectra,
    plate_inputs,
    run_inputs,
    slow_end,
    state_spectra,
)
from vehicle.engines.reduced.stated_errors import error_sentence, is_main, messages, misses_main
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.runs.car.simulated_run import NOT_COMPUTED


def test_channels_are_named_by_their_error_with_its_sign() -> None:
    sentence = error_sentence({"seat_acc_x": -0.031, "seat_acc_z": 0.019, "engine_acc_y": 0.12})
    assert sentence.endswith("RMS about +12 % (engine_acc_y), -3 % (seat_acc_x)")
    long = error_sentence({f"seat_{k}_acc_x": 0.03 + 0.01 * k for k in range(7)})
    assert "+9 % (seat_6_acc_x)" in long and long.endswith("and 3 more")
    assert error_sentence({"seat_acc_x": -0.019}) == ""
    comfort = {"weighted@seat": 0.0004, "weighted@seat_rail": -0.0061, "unweighted@seat": 0.01}
    assert error_sentence({**comfort, "engine_acc_y": 0.12}).endswith(
        "+12 % (engine_acc_y), weighted comfort (seat rail) -0.6 %"
    )


def test_comfort_alone_is_named_where_it_alone_is_off():
    close = {"weighted@seat": 0.0004, "weighted@seat_rail": -0.0061, "seat_acc_x": 0.019}
    weighted = error_sentence({**close, "weighted@seat_rail": 0.025, "unweighted@seat": 0.04})
    assert weighted.endswith(": weighted comfort (seat rail) +2.5 %")
    assert error_sentence({**close, "unweighted@seat": -0.03}).endswith(": unweighted comfort (seat) -3.0 %")
    assert error_sentence(close) == ""


def test_a_warning_is_about_comfort_its_axes_and_forces() -> None:
    comfort = {"weighted@seat": 0.0004, "seat_acc_x": 0.004, "seat_acc_z": 0.0}
    read = {"seat_acc_x", "steering_wheel_rim_acc_y", "tyre_fl_force_z", "damper_rr_force"}
    # The last ones are an axis with less than a tenth of the acceleration of its point, and a small force.
    for channel in ("knuckle_fl_acc_y", "engine_acc_x", "body_front_acc_y", "seat_acc_y", "tyre_rr_force_z"):
        warnings, (notice,) = messages({**comfort, channel: -0.2}, read)
        assert warnings == () and notice.endswith(
            f"-20 % ({channel}), weighted comfort (seat) less than 0.1 %: "
            "use the MuJoCo engine where these channels matter"
        )
    for name in ("seat_acc_x", "steering_wheel_rim_acc_y", "tyre_fl_force_z", "damper_rr_force", "weighted@seat"):
        (warning,), notices = messages({**comfort, "knuckle_fl_acc_y": -0.2, name: 0.03}, read)
        assert notices == () and warning.endswith(": use the MuJoCo engine")


def test_main_channels_decide() -> None:
    main = [
        "seat_acc_x", "seat_rail_acc_z", "body_front_acc_x", "steering_wheel_rim_acc_y", "knuckle_fr_acc_y",
        "tyre_fl_force_z", "damper_rr_force",
    ]  # fmt: skip
    assert all(misses_main({channel: -0.03}) for channel in main)
    assert not misses_main({"engine_acc_x": 0.3, "seat_acc_x": 0.01})
    assert not any(is_main(channel) for channel in ("damper_top_fl_acc_x", "roof_left_rear_acc_x", "engine_acc_z"))


@pytest.mark.parametrize(
    ("name", "road"),
    [("sedan", Road("half_round:29", speed=30.3)), ("focus_road", Road("pothole:20x300", speed=40.0))],
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
        max(abs(errors[channel] - found[channel]) for channel in found if channel.startswith(("seat", "body"))), 0.0,
        source="second derivation: MuJoCo at half its step", abs=0.01,
    )  # fmt: skip
    validated(
        "Reduced engine",
        f"{name}: stated errors of the RMS of knuckles, dampers and tyres over {road.road}, largest difference",
        max(abs(errors[channel] - found[channel]) for channel in found), 0.0,
        source="second derivation: MuJoCo at half its step", abs=0.03,
    )  # fmt: skip
    assert not reduced.statistics.within_validity and ": RMS about " in reduced.statistics.warnings[-1]


RUBBER = [
    f"{section}.bushings.{name}.{key}"
    for section, name in (("front", "arm_rear"), ("front", "arm_front"), ("rear", "pivot"))
    for key in ("friction_force=[200, 200, 200]", "friction_stroke=[2e-4, 2e-4, 2e-4]")
]


@pytest.mark.parametrize(
    ("name", "changes", "channels"),
    [("sedan_steering", [], ("steering_wheel_rim",)), ("sedan", RUBBER, ("knuckle", "seat", "body"))],
    ids=["rack", "rubber"],
)
def test_friction_of_bushings_is_linearised(name: str, changes: list[str], channels: tuple[str, ...]) -> None:
    """A rack that slides lets the steering wheel move: with its stiffness at rest the rim was stated 1.4 points off,
    and the rear knuckles on bushings with rubber friction 2.6 points."""
    car, road = Car.load(name, changes), Road("C", 60.0, duration=4.0)
    step = car.stepped().vehicle.solver.step
    whole = Car.load(name, [*changes, f"solver.timestep={step / 4.0}"]).run(road).recording
    reduced = car.run(road, engine="reduced").recording
    errors = {channel: error for channel, error in reduced.statistics.errors.items() if channel.startswith(channels)}
    found = {channel: float(np.std(reduced[channel]) / np.std(whole[channel])) - 1.0 for channel in errors}
    assert min(found.values()) < -0.01
    validated(
        "Reduced engine",
        f"{name}, bushings with friction{' everywhere' if changes else ' at the rack'}: stated errors of the RMS of "
        f"{', '.join(channels)} on class C, largest difference",
        max(abs(errors[channel] - found[channel]) for channel in errors), 0.0,
        source="second derivation: MuJoCo at a quarter of its step", abs=0.005 if name == "sedan_steering" else 0.01,
    )  # fmt: skip


def test_every_nonlinear_element_is_in_the_linear_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    """The motion of the poles under the forces of all elements is that of the record: no element may be left out."""
    changes = [
        "front.damper.stop={displacement=[-0.03, -0.002, 0.002, 0.03], force=[-2800.0, 0.0, 0.0, 2800.0]}",
        "front.damper.friction_law=presliding",
        "front.damper.presliding_stiffness=1e6",
        "front.bushings.tyre.one_sided=true",
        *RUBBER,
    ]
    car, calls = Car.load("sedan_steering", changes), list[tuple[Any, ...]]()

    def kept(*given: Any) -> tuple[dict[str, float], frozenset[str]]:
        # The run adds the forces of stops to those of dampers later.
        calls.append((*given[:5], {name: history.copy() for name, history in given[5].items()}, given[7]))
        return {}, frozenset()

    monkeypatch.setattr(reduced_run, "rms_errors_of", kept)
    car.run(Road("D", 60.0, duration=4.0), engine="reduced")
    ((model, _, _, signal, time, record, tyre_load),) = calls
    assert model.groups and {law.friction for law in model.laws} == {False, True}
    assert model.element_forces.shape[1] == len(car.vehicle.composition.dampers) + len(model.laws)
    assert len(model.element_outputs.poles) == model.element_forces.shape[1]
    histories = run_inputs(model, plate_inputs(model, signal, time, record, tyre_load), record, time)
    spectra, samples = periodic_spectra(histories - histories[:, :1], 1e-3, 3)
    spectra = state_spectra(model, spectra, 3e-3, samples)
    lacking, end = continued(model, spectra, 3e-3, samples, time[::3].size, None)
    # The slow poles at the end of a window by an integral over time.
    direct = slow_end(model, (histories - histories[:, :1])[:, ::3], 3e-3, None)
    # 0.34 %: the last sample is held for the interval after it.
    assert np.max(np.abs(direct - end)) < 0.01 * np.max(np.abs(end))
    state = np.fft.irfft(spectra, samples, axis=1)
    state[: len(lacking)] += lacking
    acceleration = motion_rows(model).acceleration @ state
    for channel in ("seat_rail_acc_z", "steering_wheel_rim_acc_y"):
        row = model.matrices.system.outputs[channel][: model.matrices.system.size]
        ours = (row @ acceleration)[: time[::3].size]
        # What is above 90 Hz is left out.
        theirs = record[channel][::3]
        assert np.std(ours - theirs) < 0.05 * np.std(theirs), channel


def test_parts_of_a_record_state_what_the_whole_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each part continues the one before. When each began about its mean, knuckles were stated up to 6 points apart."""
    car, road = Car.load("sedan"), Road("C", speed=100.0, duration=6.0, seed=3)
    found = list[dict[str, float]]()
    monkeypatch.setattr(second_order, "SHARE", 3.0)
    for window in (30.0, 3.0):
        monkeypatch.setattr(second_order, "WINDOW", window)
        found.append(dict(car.run(road, engine="reduced").recording.statistics.errors))
    whole, parts = found
    validated(
        "Reduced engine",
        "sedan on class C: stated errors of all main channels in two parts of 3 s, largest difference from the whole",
        max(abs(parts[channel] - whole[channel]) for channel in whole if is_main(channel)), 0.0,
        source="second derivation: the record of 6 s as a whole", abs=0.01,
    )  # fmt: skip


def test_a_window_with_most_motion_states_about_what_the_whole_record_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """One window of 8 s of 24 s, which is not the first; the slow poles before it are moved on by themselves."""
    car, road = Car.load("sedan"), Road("D", speed=80.0, duration=24.0, seed=3)
    sampled = car.run(road, engine="reduced").recording.statistics.errors
    monkeypatch.setattr(second_order, "SHARE", 1.0)
    whole = car.run(road, engine="reduced").recording.statistics.errors
    ratios = [sampled[name] / whole[name] for name in whole if is_main(name) and abs(whole[name]) > 0.02]
    # 1.05 to 1.30 here; "about" in the message is a factor of two.
    assert len(ratios) > 5 and min(ratios) > 0.5 and max(ratios) < 2.0
    assert sampled != whole


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


def test_errors_are_left_out_without_a_change_of_the_run(tmp_path, capsys) -> None:
    """Nothing is claimed: neither errors nor the wider range that they allow; "auto" then takes MuJoCo."""
    car, road = Car.load("sedan"), Road("C", speed=60.0, duration=3.0)
    stated = car.run(road, "reduced", channels=["seat_acc_z"])
    run = car.run(road, "reduced", channels=["seat_acc_z"], stated_errors=False)
    np.testing.assert_array_equal(run["seat_acc_z"], stated["seat_acc_z"])
    statistics = run.recording.statistics
    assert stated.recording.statistics.errors and not statistics.errors
    assert NOT_COMPUTED in statistics.notices and NOT_COMPUTED not in stated.recording.statistics.notices
    assert stated.recording.statistics.within_validity and not statistics.within_validity
    # The second run finds the matrices of the first.
    assert run.car is stated.car and car.run(replace(road, speed=50.0), "reduced").car is not run.car
    words = ["--input", "bump_1p5mm.csv", "--engine", "reduced", "--no-figures", "--output", f"{tmp_path}/run"]
    assert shaker([*words, "--no-stated-errors"]) == 0 and NOT_COMPUTED in capsys.readouterr().out
    assert NOT_COMPUTED in json.loads((tmp_path / "run/summary.json").read_text())["notices"]
