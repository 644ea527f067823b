"""Two cars side by side: each moves as its recording says, at the same time and to the same scale."""

import dataclasses
import pickle
from itertools import islice
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from tests.drawing.rendering.conftest import POSE_STEP, FakeCar, FakeRun, fabricated
from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.layout import TwoCars, font
from vehicle.drawing.rendering.overlay import SLIP_COLOUR, STICK_COLOUR
from vehicle.drawing.rendering.pair_shot import PairShot, differing_dampers, fitted, two_lines
from vehicle.drawing.rendering.scene import exaggeration_of
from vehicle.drawing.rendering.shot import Take
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

STEPWISE = Take(start=0.1, duration=0.2, slow=1.0 / (30.0 * POSE_STEP), exaggeration=1.0)
"""A frame for each stored pose."""


def beside(run, car, *, level=2e-3, **channels):
    """A run on the same plates: its car moves `level` over 1e-3 times as far, and its dampers stick."""
    recording = fabricated(car, 0.3, level)
    kept = {name: values for name, values in run.recording.channels.items() if name.startswith("plate_")}
    stick = {"damper_fr_velocity": 0.0 * recording.time}
    recording = dataclasses.replace(recording, channels={**recording.channels, **kept, **stick, **channels})
    return FakeRun(car=FakeCar(model=car), recording=recording)


@pytest.fixture(scope="module")
def pair(run, car):
    return PairShot({"A": run, "B": beside(run, car)}, "B against A", TwoCars(width=640, height=360), STEPWISE)


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_both_cars_stand_in_the_scene_where_their_recordings_say(pair, run, car):
    model, data = car.model, mujoco.MjData(car.model)
    recordings = [run.recording, beside(run, car).recording]
    for scene, recording in zip(pair.scenes, recordings, strict=True):
        body = scene.model.body("knuckle_fr").id
        geom = next(n for n in range(scene.model.ngeom) if scene.model.geom_bodyid[n] == body)
        with scene.opened(choose_backend(), 1.0, 1e-3) as opened:
            opened.draw(0, [])
            rest = scene.motion.geoms(dataclasses.replace(scene.states[0]), 0.0)[0][geom]
            for number in (0, 3):
                opened.draw(number, [])
                data.qpos[:] = recording.poses[round(scene.times[number] / POSE_STEP)]
                mujoco.mj_kinematics(model, data)
                name = model.body("knuckle_fr").id
                turned = data.xmat[name].reshape(3, 3) @ scene.model.geom_pos[geom] + data.xpos[name]
                moved = np.linalg.norm(turned - rest)
                assert moved > 3e-4
                # The mean over the frame: (w h)^2 / 24 less, and the smooth curve between the poses.
                assert np.linalg.norm(opened.drawing.data.geom_xpos[geom] - turned) < 2e-3 * moved


def test_both_halves_show_the_same_time_to_the_same_scale(pair, run):
    left, right = pair.scenes
    assert left.times == right.times == pytest.approx(0.1 + POSE_STEP * np.arange(6))
    assert left.arrows.top == right.arrows.top
    assert right.largest == pytest.approx(2.0 * left.largest, rel=0.05)
    assert pair.scale_top >= max(left.node, right.node)
    assert left.lamps(0.2)["damper right"] and not right.lamps(0.2)["damper right"]


@pytest.mark.parametrize(
    ("changes", "wheels"),
    [
        ({"front.main_spring.stiffness": 3e4}, ()),
        ({"rear.damper.viscous": 900.0}, ("rr",)),
        ({"*.damper.coulomb_friction": 30.0}, ("fr", "rr")),
    ],
)
def test_the_curve_is_that_of_the_dampers_that_differ(changes, wheels):
    cars = [Car.load("focus_road"), Car.load("focus_road", changes)]
    runs = [SimpleNamespace(car=SimpleNamespace(model=SimpleNamespace(vehicle=car.vehicle)), wheel="fr")
            for car in cars]  # fmt: skip
    assert differing_dampers(runs) == wheels


def test_the_curve_of_a_damper_is_labelled_by_its_wheel(run, car):
    other = beside(run, car)
    changed = dataclasses.replace(car.vehicle, composition=_with_other_dampers(car.vehicle.composition))
    other = dataclasses.replace(other, car=FakeCar(model=dataclasses.replace(car, vehicle=changed)))
    shot = PairShot({"A": run, "B": other}, "", TwoCars(width=320, height=180), STEPWISE)
    assert [trace.label for trace in shot.overlay.strip.traces][-1] == "damper right [mm/s]"


def _with_other_dampers(composition):
    laws = [dataclasses.replace(damper.law, coulomb_friction=1.0) for damper in composition.dampers]
    dampers = [dataclasses.replace(damper, law=law) for damper, law in zip(composition.dampers, laws, strict=True)]
    return dataclasses.replace(composition, dampers=tuple(dampers))


def test_the_exaggeration_is_that_of_the_car_that_moves_more(run, car):
    take = Take(start=0.1, duration=0.1, slow=1.0)
    faster = beside(run, car, level=1e-2)
    shot = PairShot({"A": run, "B": faster}, "", TwoCars(width=320, height=180), take)
    slow, fast = (exaggeration_of(scene.largest, None) for scene in shot.scenes)
    assert slow > 5.0 * fast == 5.0 * shot.cut.exaggeration


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_a_frame_has_a_car_its_name_and_its_lamps_in_each_half(run, car):
    still = beside(run, car, level=0.0)
    shot = PairShot(
        {"A": run, "B": still},
        "B against A",
        TwoCars(width=640, height=360),
        dataclasses.replace(STEPWISE, start=0.12, duration=0.3, exaggeration=None),
    )
    again = pickle.loads(pickle.dumps(shot))  # as other processes get it
    first, later = (frame.astype(int) for frame in islice(again.frames(choose_backend(), 0, 8), 2))
    assert first.shape == (360, 640, 3)
    view = slice(116, 146)  # between lamps and dampers; plates and arrows move in both halves
    moved = np.abs(later - first)[view].max(axis=2)
    assert (moved[:, :320] > 10).sum() > 100, "the car on the left moves"
    assert moved[:, 324:].max() == 0, "the car on the right stands still"
    lamps = [later[60:140, part].reshape(-1, 3) for part in (slice(320), slice(320, 640))]
    for pixels, slips in zip(lamps, (True, False), strict=True):
        assert (pixels == SLIP_COLOUR).all(axis=1).any() == slips
        assert (pixels == STICK_COLOUR).all(axis=1).any()


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ({"plate_fr_displacement": np.zeros(301)}, "wheel fr of A and of B"),
        (None, r"A lasts 0\.3 s, B lasts 0\.2 s"),
    ],
)
def test_runs_on_other_inputs_are_refused(run, car, channels, message):
    other = beside(run, car, **channels) if channels else FakeRun(car=run.car, recording=fabricated(car, 0.2))
    with pytest.raises(ConfigurationError, match=message):
        PairShot({"A": run, "B": other}, "", TwoCars(width=320, height=180), STEPWISE)


def test_a_long_caption_takes_two_lines_and_then_ends_with_an_ellipsis():
    letters, words = font(17, True), "front damper Coulomb friction 0 instead of 80 N, rear damper 0 instead of 40 N"
    assert two_lines(words, letters, 2000.0) == [words]
    lines = two_lines(words, letters, 500.0)
    assert len(lines) == 2 and " ".join(lines) == words
    cut = two_lines(words, letters, 300.0)
    assert len(cut) == 2 and cut[1].endswith("…") and all(letters.getlength(line) <= 300.0 for line in cut)
    assert fitted("short", letters, 300.0) == "short"
