"""Two runs of one input side by side: the same times, exaggeration, colours and lengths of arrows in both halves."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from vehicle.drawing.rendering.cameras import farther, whole_car
from vehicle.drawing.rendering.caption import Caption
from vehicle.drawing.rendering.excerpt import Excerpt
from vehicle.drawing.rendering.layout import INK, PAPER, Picture, TwoCars
from vehicle.drawing.rendering.overlay import draw_lamps
from vehicle.drawing.rendering.recorded_run import RecordedRun
from vehicle.drawing.rendering.rounding import round_up
from vehicle.drawing.rendering.scene import AT_REST, Scene
from vehicle.drawing.rendering.shot import (
    VISIBLE_TIME,
    Take,
    cut_of,
    excerpt_of,
    input_words,
    scale_words,
    speed_words,
    traces,
)
from vehicle.drawing.rendering.trace_strip import PAIR_COLOURS, TraceStrip
from vehicle.errors import ConfigurationError

SAME_PLATES = 0.05
"""Largest RMS of the difference of two plates over the RMS of the plate in films of one input: tyres of other sizes
take a road a little differently."""


class PairShot:
    """Excerpt of two runs for drawing frame by frame.

    Args:
        runs: name to run, two; the first is the reference.
        difference: what differs, in a line.
        layout: layout of the frame.
        take: settings of the film.

    Raises:
        ConfigurationError: the runs have other inputs or durations, or the start is outside the record.
    """

    def __init__(self, runs: Mapping[str, RecordedRun], difference: str, layout: TwoCars, take: Take) -> None:
        require_one_input(runs)
        both = list(runs.values())
        dampers = differing_dampers(both)
        excerpt = shared_excerpt(both, take, dampers[0] if dampers else None)
        size = (layout.main_width, layout.view_height)
        self.layout = layout
        self.scenes = [Scene(run, size, excerpt, take.speed, take.profile) for run in both]
        largest = max(scene.largest for scene in self.scenes)
        self.cut = cut = cut_of(excerpt, largest, take)
        self.scale_top = 1e-3 * round_up(1e3 * max(*(scene.node for scene in self.scenes), AT_REST))
        top = max(scene.arrows.top for scene in self.scenes)
        for scene in self.scenes:
            scene.arrows.top = top
        visible = VISIBLE_TIME / np.sqrt(excerpt.slow)
        slips = dict.fromkeys(scene.slip_text for scene in self.scenes if scene.slip_text)
        exaggerated = "motion" if self.scenes[0].road is None else "motion and road"
        scale = f"{exaggerated} {scale_words(cut, rests=largest < AT_REST)}, {speed_words(cut, excerpt.slow)}"
        self.overlay = PairOverlay(
            layout=layout,
            heading=[
                difference,
                f"{input_words(both[0])}; excerpt from {cut.start:.2f} s ({excerpt.reason})",
                scale + (f"; SLIP: above {' and '.join(slips)} mm/s" if slips else ""),
                *filter(None, [self.scenes[0].arrows.words]),
            ],
            scale_top=1e3 * self.scale_top,
            names=tuple(runs),
            strip=TraceStrip(
                layout=layout,
                time=both[0].recording.time,
                traces=traces(self.scenes, cut, visible, dampers),
                visible=visible,
            ),
        )

    def frames(self, backend: str, first: int = 0, every: int = 1) -> Iterator[Picture]:
        """Draw frames; see `Shot.frames`."""
        width, height = self.layout.main_width, self.layout.view_height
        views = [
            [(farther(whole_car(scene.vehicle), width / height), (0, 0, width, height), scene.opacity)]
            for scene in self.scenes
        ]
        with ExitStack() as stack:
            opened = [
                stack.enter_context(scene.opened(backend, self.cut.exaggeration, self.scale_top))
                for scene in self.scenes
            ]
            for number in range(first, self.cut.frames, every):
                pictures, time = [], self.scenes[0].times[number]
                for each, views_of_it in zip(opened, views, strict=True):
                    each.draw(number, views_of_it)
                    pictures.append(each.canvas.read().copy())
                yield self.overlay.draw(pictures, time, [scene.lamps(time) for scene in self.scenes])


def require_one_input(runs: Mapping[str, RecordedRun]) -> None:
    """Check that two runs can be shown side by side.

    Raises:
        ConfigurationError: their lengths or the motions of their plates differ.
    """
    (first, reference), (second, compared) = runs.items()
    ends = [float(run.recording.time[-1]) for run in (reference, compared)]
    if abs(ends[0] - ends[1]) > max(reference.recording.timestep, compared.recording.timestep):
        raise ConfigurationError(
            f"video: {first} lasts {ends[0]:g} s, {second} lasts {ends[1]:g} s; two cars side by side need one input"
        )
    for wheel in dict.fromkeys((reference.wheel, compared.wheel)):
        channel = f"plate_{wheel}_displacement"
        if channel in reference.recording.channels and channel in compared.recording.channels:
            plate = reference.recording[channel]
            beside = np.interp(reference.recording.time, compared.recording.time, compared.recording[channel])
            if np.sqrt(np.mean((plate - beside) ** 2)) <= SAME_PLATES * np.sqrt(np.mean(plate**2)):
                continue
        raise ConfigurationError(
            f"video: the plates under the wheel {wheel} of {first} and of {second} move differently; two cars side by "
            "side need one input"
        )


def differing_dampers(runs: Sequence[RecordedRun]) -> tuple[str, ...]:
    """Return a wheel of each axle whose damper differs between two cars, on the side of the excited wheel if it does.

    Returns:
        The wheels; empty for cars with the same dampers, or without a common damper.
    """
    cars = [run.car.model.vehicle.composition for run in runs]
    laws = [{damper.name.removeprefix("damper_"): damper.law for damper in car.dampers} for car in cars]
    placed = {wheel.name: wheel for wheel in cars[0].wheels}
    differing = [wheel for wheel in laws[0] if wheel in placed and laws[0][wheel] != laws[1].get(wheel)]
    side = placed[runs[0].wheel].side
    by_axle: dict[str, str] = {}
    for wheel in sorted(differing, key=lambda wheel: placed[wheel].side != side):
        by_axle.setdefault(placed[wheel].axle, wheel)
    return tuple(wheel for wheel in placed if wheel in by_axle.values())


def shared_excerpt(runs: Sequence[RecordedRun], take: Take, wheel: str | None = None) -> Excerpt:
    """Return the excerpt of two runs: that of the first whose dampers slip, as slow as the faster of both needs.

    Args:
        runs: the runs.
        take: settings of the film.
        wheel: see `excerpt_of`.
    """
    excerpts = [excerpt_of(run, take, wheel) for run in runs]
    slips = [excerpt.reason == "most damper motion" for excerpt in excerpts]
    chosen = runs[slips.index(True) if any(slips) else 0]
    return excerpt_of(chosen, replace(take, slow=max(excerpt.slow for excerpt in excerpts)), wheel)


@dataclass(frozen=True, kw_only=True, eq=False)
class PairOverlay(Caption):
    """Writer of text and traces on frames of two runs."""

    names: tuple[str, ...]
    """names of the runs"""
    strip: TraceStrip
    """traces below the views"""

    def draw(self, pictures: Sequence[Picture], time: float, lamps: Sequence[Mapping[str, bool]]) -> Picture:
        """Compose a frame.

        Args:
            pictures: view of each car, (height, width, 3).
            time: time [s].
            lamps: label of each damper to True if it slips, of each car.

        Returns:
            The whole frame, (height, width, 3).
        """
        layout, px, font = self.layout, self.layout.px, self.layout.font
        image, top, half = self.strip.backdrop.copy(), layout.trace_top - layout.view_height, layout.main_width
        pen = ImageDraw.Draw(image)
        right, x, y = layout.width - px(16), px(16), px(8)
        pen.text((right, y), f"t = {time:.3f} s", fill=INK, font=font(21, True), anchor="ra")
        wide = right - px(190) - x
        title, *others = self.heading
        size = 21 if font(21, True).getlength(title) <= wide else 17
        for line in two_lines(title, font(size, True), wide):
            pen.text((x, y), line, fill=INK, font=font(size, True))
            y += px(27 if size == 21 else 23)
        y += px(2)
        for line in others:
            pen.text((x, y), fitted(line, font(15), wide - px(210)), fill=INK, font=font(15))
            y += px(19)
        image.paste(self.colour_bar, (right - self.colour_bar.width, px(46)))
        for number, (picture, of_car, name) in enumerate(zip(pictures, lamps, self.names, strict=True)):
            left = number * half
            image.paste(Image.fromarray(np.ascontiguousarray(picture)), (left, top))
            tag, size = left + px(16), px(18)
            pen.rectangle([tag, top + px(14), tag + size, top + px(14) + size], fill=PAIR_COLOURS[number])
            letters = font(21, True)
            shown = fitted(name, letters, half - px(60))
            pen.text((tag + size + px(10), top + px(23)), shown, fill=INK, font=letters, anchor="lm")
            draw_lamps(pen, layout, of_car, (left + half - px(12), top + px(42)), columns=2)
        pen.line([(half, top), (half, layout.trace_top)], fill=PAPER, width=px(3))
        self.strip.draw(image, time)
        return np.asarray(image)


def two_lines(text: str, letters: ImageFont.FreeTypeFont, width: float) -> list[str]:
    """Return a text in one or two lines of at most this width [pixel]."""
    parts = text.split()
    count = next((n for n in range(len(parts), 1, -1) if letters.getlength(" ".join(parts[:n])) <= width), 1)
    return [fitted(" ".join(part), letters, width) for part in (parts[:count], parts[count:]) if part]


def fitted(text: str, letters: ImageFont.FreeTypeFont, width: float) -> str:
    """Return a text of at most this width [pixel]; the end of a longer text becomes an ellipsis."""
    if letters.getlength(text) <= width:
        return text
    while text and letters.getlength(f"{text}…") > width:
        text = text[:-1]
    return f"{text.rstrip(' ,;')}…"
