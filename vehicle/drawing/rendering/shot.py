"""Excerpt of a run, drawn frame by frame: the car, a close-up, and text."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.cameras import close_up, whole_car
from vehicle.drawing.rendering.excerpt import Excerpt, choose_excerpt
from vehicle.drawing.rendering.layout import Layout, Picture
from vehicle.drawing.rendering.mode_inset import BesideMode, ModeInset
from vehicle.drawing.rendering.overlay import Overlay
from vehicle.drawing.rendering.recorded_run import RecordedRun, hub_channel, level_words
from vehicle.drawing.rendering.rounding import round_up
from vehicle.drawing.rendering.scene import AT_REST, Scene, View, exaggeration_of, frames_of
from vehicle.drawing.rendering.trace_strip import Trace, TraceStrip
from vehicle.errors import ConfigurationError
from vehicle.names import side_of
from vehicle.signals.analysis.samples import Vector

FASTEST_MOTION = 40.0
"""Maximum frequency [Hz] of visible motion; the heading of a film with fewer than two frames per period states it."""

VISIBLE_TIME = 2.0
"""Visible time of the traces in real time [s]; divided by the square root of the slow-motion factor otherwise."""

LEAST_ACCELERATION = 1e-3
"""Minimum end of the scale of an acceleration [m/s2]: a hundredth of what a person feels, so rounding stays a line."""

GHOST_OPACITY = 0.22
"""Opacity of the wheel in the close-up, where it would hide the strut."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Take:
    """Settings of a film.

    Raises:
        ConfigurationError: a number is out of range.
    """

    start: float | None = None
    """first time of the record [s]; by default, a single event or the window with the largest motion"""
    duration: float | None = None
    """length of the film [s], which shows duration / slow of the record at most; 10 s or a single event by default"""
    slow: float | None = None
    """slow-motion factor, at least 1; by default, of the whole record (see `choose_excerpt`)"""
    exaggeration: float | None = None
    """factor of all motion; by default, the largest displacement becomes 5 to 8 cm"""
    speed: float | None = None
    """speed on the road [m/s], to draw the moving road; None on a rig"""
    profile: tuple[Vector, Mapping[str, Vector]] | None = None
    """times [s], and heights of the road itself by wheel [m]; by default, the road is drawn as the plates move"""
    mode: BesideMode | None = None
    """mode to show in place of the close-up"""

    def __post_init__(self) -> None:
        if self.duration is not None and not 0.0 < self.duration < np.inf:
            raise ConfigurationError(f"video, duration: found {self.duration:g} s, must be above 0 and finite")
        if self.slow is not None and not 1.0 <= self.slow < np.inf:
            raise ConfigurationError(f"video, slow motion: found {self.slow:g}, must be at least 1")
        if self.exaggeration is not None and not 0.0 < self.exaggeration < np.inf:
            raise ConfigurationError(f"video, exaggeration: found {self.exaggeration:g}, must be above 0 and finite")


@dataclass(frozen=True, kw_only=True, slots=True)
class Cut:
    """Excerpt of a record in a film."""

    start: float
    """first time [s]"""
    frames: int
    """number of frames"""
    interval: float
    """time of the record between two frames [s]"""
    exaggeration: float
    """factor of all motion"""
    reason: str
    """reason for the start"""

    @property
    def end(self) -> float:
        """Return the time of the last frame [s]."""
        return self.start + (self.frames - 1) * self.interval


class Shot:
    """Excerpt of a run for drawing frame by frame.

    Args:
        run: the run.
        layout: layout of the frame.
        take: settings of the film.

    Raises:
        ConfigurationError: the start is outside the record.
    """

    def __init__(self, run: RecordedRun, layout: Layout, take: Take) -> None:
        excerpt = excerpt_of(run, take)
        self.layout = layout
        self.scene = scene = Scene(run, (layout.width, layout.view_height), excerpt, take.speed, take.profile)
        self.inset = None if take.mode is None else ModeInset(scene, run.car.model, take.mode, layout)
        self.cut = cut_of(excerpt, scene.largest, take)
        self.scale_top = 1e-3 * round_up(1e3 * max(scene.node, AT_REST))
        self.visible = VISIBLE_TIME / np.sqrt(excerpt.slow)
        self.overlay = Overlay(
            layout=layout,
            heading=self._heading(run, excerpt.slow),
            inset=self.inset,
            scale_top=1e3 * self.scale_top,
            strip=TraceStrip(
                layout=layout,
                time=run.recording.time,
                traces=traces([scene], self.cut, self.visible),
                visible=self.visible,
            ),
        )

    def frames(self, backend: str, first: int = 0, every: int = 1) -> Iterator[Picture]:
        """Draw frames, (height, width, 3) each.

        Args:
            backend: OpenGL backend, one of `BACKENDS`.
            first, every: the first frame and the distance to the next; all by default.
        """
        views, scene = self._views(), self.scene
        with scene.opened(backend, self.cut.exaggeration, self.scale_top) as opened:
            mode = None if self.inset is None else self.inset.drawing(opened.canvas)
            for number in range(first, self.cut.frames, every):
                opened.draw(number, views)
                if self.inset is not None and mode is not None:
                    self.inset.draw(mode, number)
                time = scene.times[number]
                yield self.overlay.draw(opened.canvas.read(), time, scene.lamps(time))

    def _views(self) -> list[View]:
        """Return the view of the whole car, and that of the suspension in a film without a mode."""
        layout, scene = self.layout, self.scene
        model, wheel = scene.model, scene.wheel
        cleared = scene.unveiled.copy()
        rolling = next(placed.part for placed in scene.composition.wheels if placed.name == wheel)
        cleared[model.geom_matid[model.geom_bodyid == model.body(rolling).id]] = GHOST_OPACITY
        whole = (whole_car(scene.vehicle), (0, 0, layout.main_width, layout.view_height), scene.opacity)
        if self.inset is not None:
            return [whole]
        right = (layout.main_width, 0, layout.width - layout.main_width, layout.view_height)
        return [whole, (close_up(scene.motion, scene.vehicle, wheel), right, cleared)]

    def _heading(self, run: RecordedRun, slow: float) -> list[str]:
        """Return the heading: input and level, factors and excerpt."""
        cut, scene = self.cut, self.scene
        road, exaggerated = [], "motion"
        if scene.road is not None:
            road = [
                f"road passes at {3.6 * scene.road.speed:.4g} km/h, a stripe is {scene.road.stripe:g} m long; "
                "heights in numbers: after averaging by the tyre"
            ]
            exaggerated = "motion and road"
        return [
            input_words(run),
            f"{exaggerated} {scale_words(cut, rests=scene.largest < AT_REST)}, {speed_words(cut, slow)}",
            *road,
            f"excerpt from {cut.start:.2f} s ({cut.reason}); "
            f"{f'SLIP: above {scene.slip_text} mm/s; ' if scene.slip_text else ''}"
            f"tyres {scene.vehicle.driving.words}",
            *filter(None, [scene.arrows.words]),
        ]


def excerpt_of(run: RecordedRun, take: Take, wheel: str | None = None) -> Excerpt:
    """Return the excerpt of a run in a film.

    Args:
        run: the run.
        take: settings of the film.
        wheel: wheel of the damper that decides; default: the excited wheel.

    Raises:
        ConfigurationError: the start is outside the record.
    """
    recording, vehicle = run.recording, run.car.model.vehicle
    record = float(recording.time[-1])
    if take.start is not None and not 0.0 <= take.start < record:
        raise ConfigurationError(f"video, start: found {take.start:g} s, must be 0 to {record:g} s, within the record")
    wheel = wheel or run.wheel
    hub, slip = hub_channel(vehicle.composition, wheel), vehicle.slip_velocities.get(wheel)
    return choose_excerpt(recording, wheel, hub, slip, start=take.start, duration=take.duration, slow=take.slow)


def cut_of(excerpt: Excerpt, largest: float, take: Take) -> Cut:
    """Return the frames of an excerpt whose largest displacement [m] is known."""
    frames, interval = frames_of(excerpt)
    factor = exaggeration_of(largest, take.exaggeration)
    return Cut(start=excerpt.start, frames=frames, interval=interval, exaggeration=factor, reason=excerpt.reason)


def input_words(run: RecordedRun) -> str:
    """Return the input of a run, its level and its wheel."""
    level = level_words(run.recording, run.wheel, run.signal.rms(run.wheel))
    wheel = run.car.model.vehicle.wheel_text(run.wheel, source=False)
    return f"{Path(run.signal.source).name}: {level} under the {wheel}"


def speed_words(cut: Cut, slow: float) -> str:
    """Return the speed of a film, and the frequency above which motion averages out if it may be seen."""
    speed = "real time" if slow == 1.0 else f"slow motion 1 : {slow:g}"
    highest = 0.5 / cut.interval
    return speed + (f" (faster than {highest:g} Hz averages out)" if highest < FASTEST_MOTION else "")


def scale_words(cut: Cut, *, rests: bool) -> str:
    """Return the exaggeration of a film; `rests` for a car at rest."""
    scale = f"exaggerated {cut.exaggeration:g} times" if cut.exaggeration != 1.0 else "true to scale"
    return scale + (" (at rest)" if rests else "")


def traces(scenes: Sequence[Scene], cut: Cut, visible: float, dampers: Sequence[str] = ()) -> list[Trace]:
    """Return the curves below the picture (plate, seat rail, damper), scaled to their maxima in the shown time.

    Args:
        scenes: a scene, or two with the same plates, whose curves lie over each other.
        cut: shown excerpt.
        visible: length of the curves on the screen [s].
        dampers: wheels whose dampers have a curve; default: the excited wheel.
    """
    first, wheel = scenes[0], scenes[0].wheel
    time = first.recording.time
    inside = (time >= cut.start - 0.5 * visible) & (time <= cut.end + 0.5 * visible)
    curves = []
    input_label = "plate [mm]" if first.road is None else "effective road [mm]"
    for label, channel, scale, band, minimum in (
        (input_label, f"plate_{wheel}_displacement", 1e3, None, 1e3 * AT_REST),
        ("seat rail, vertical [m/s²]", "seat_rail_acc_z", 1.0, None, LEAST_ACCELERATION),
        *(
            (f"damper {side_of(name, first.wheels)} [mm/s]", f"damper_{name}_velocity", 1e3, _band(scenes, name), 0.0)
            for name in dampers or (wheel,)
        ),
    ):
        if not all(channel in scene.recording.channels for scene in scenes):
            continue
        shown = scenes if channel != f"plate_{wheel}_displacement" else scenes[:1]
        values = tuple(scale * np.interp(time, scene.recording.time, scene.recording[channel]) for scene in shown)
        peak = max(float(np.max(np.abs(history[inside]))) for history in values)
        top = round_up(max(peak, 1.2 * (band or 0.0), minimum))
        curves.append(Trace(label=label, values=values, top=top, band=band))
    return curves


def _band(scenes: Sequence[Scene], wheel: str) -> float | None:
    """Return the slip velocity of a damper [mm/s]; None without it, or if it differs between the scenes."""
    limits = {scene.slip.get(wheel) for scene in scenes}
    limit = limits.pop()
    return None if limits or limit is None else 1e3 * limit
