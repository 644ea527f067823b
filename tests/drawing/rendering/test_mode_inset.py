"""A mode beside a run: its own cycle in its own part of the frame, and the run as without it."""

import pytest

from vehicle.commands.modes import modes_table
from vehicle.drawing.rendering import mode_inset, mode_motion
from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.layout import Layout
from vehicle.drawing.rendering.mode_inset import BesideMode
from vehicle.drawing.rendering.shot import Shot, Take
from vehicle.runs.car import Car


@pytest.fixture(scope="module")
def whole(car):
    own = Car.load()
    own.model = car  # built once for all tests of films
    return own


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_the_mode_repeats_beside_the_unchanged_run(run, whole, monkeypatch):
    for module in (mode_inset, mode_motion):
        monkeypatch.setattr(module, "PERIOD", 2)
    layout, mode = Layout(width=320, height=180), whole.modes()[3]
    alone, beside = (
        list(Shot(run, layout, Take(start=0.0, duration=0.1, slow=1.0, mode=shown)).frames(choose_backend()))
        for shown in (None, BesideMode(mode=mode))
    )
    left, right = slice(0, layout.main_width - 2), slice(layout.main_width + 2, 320)
    for frame, other in zip(alone, beside, strict=True):
        assert (frame[:, left] == other[:, left]).all(), "the mode must not move the car of the run"
    below = slice(100, layout.view_height)
    first, half, again = (frame[below, right].astype(int) for frame in beside)
    assert (first == again).all() and abs(first - half).max() > 40


def test_the_frequency_beside_a_run_is_that_of_the_command_modes(run, whole):
    printed = modes_table(whole, "stuck", ())["modes"][3]
    shown = BesideMode(mode=whole.modes()[3], words=["share: 41 %"])
    inset = Shot(run, Layout(width=320, height=180), Take(start=0.0, duration=0.05, slow=1.0, mode=shown)).inset
    assert inset is not None
    frequency, damping = f"{printed['frequency_hz']:.2f} Hz", f"{100.0 * printed['damping_ratio']:.2f} %"
    assert inset.lines[:3] == [f"mode: {frequency}, damping ratio {damping}", printed["description"], "share: 41 %"]
    slow = printed["frequency_hz"] * 40 / 30
    assert inset.lines[3] == f"exaggerated 250 times, slow motion 1 : {slow:.3g}"
