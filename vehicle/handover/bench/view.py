"""Choice of the moving picture on the page: the run, or a mode with the dampers stuck or sliding."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from vehicle.arrays import Complex
from vehicle.engines.linear.car_modes import Mode
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.drive import BenchDrive
from vehicle.handover.bench.motion import car_motion, mode_motion
from vehicle.handover.bench.stage import CYCLE, LARGER, SLOWER, Stage
from vehicle.runs.car import Car
from vehicle.runs.report.modes_section import ride_share
from vehicle.signals.analysis.modal_assurance import mac

RUN = "run"
STATES = {"modes, dampers stuck": "stuck", "modes, dampers sliding": "sliding"}
"""Choices of the list with the state of the dampers of each."""

SLOWEST, LARGEST = 100.0, 200.0
"""Maximum slow motion, and maximum exaggeration or amplitude [mm]."""


class View:
    """Elements of the page for the moving picture.

    Args:
        gui: GUI of a viser server; the elements are added to its present folder.
        stage: the moving picture.
        drive: input of the bench.

    Attributes:
        modes: listed modes of the shown car; empty for a run.
    """

    def __init__(self, gui: Any, stage: Stage, drive: BenchDrive) -> None:
        self.stage, self.drive = stage, drive
        self.modes: list[Mode] = []
        self._car: Car | None = None
        self._chosen: Complex | None = None
        self._enlarged: float | None = None
        self.kind = gui.add_dropdown("picture of", (RUN, *STATES))
        self.mode = gui.add_dropdown("mode", ("none",), visible=False, hint="natural frequency, damping ratio, motion")
        self.amplitude = gui.add_slider(
            "amplitude [mm]", 1.0, LARGEST, 1.0, LARGER, visible=False, hint="of the farthest point of the car"
        )
        self.slower = gui.add_slider("slow motion", 1.0, SLOWEST, 1.0, SLOWER)
        self.larger = gui.add_slider("exaggeration", 1.0, LARGEST, 0.5, 1.0)
        self.playing = gui.add_checkbox("playing", True)

    def connect(self, on: Callable[[Any, Callable[[], None]], None], again: Callable[[], None]) -> None:
        """Connect the elements.

        Args:
            on: function that calls a function after each change of an element in a browser.
            again: function that calls `show` with the present car.
        """
        on(self.kind, again)
        on(self.mode, self._choose)
        on(self.amplitude, lambda: setattr(self.stage, "larger", _limited(self.amplitude)))
        on(self.slower, lambda: setattr(self.stage, "slower", _limited(self.slower)))
        on(self.larger, self._enlarge)
        on(self.playing, lambda: setattr(self.stage, "playing", bool(self.playing.value)))

    def show(self, car: Car) -> None:
        """Compute and show the chosen motion of a car; the caller holds the lock of the callbacks of MuJoCo.

        Another car keeps the chosen mode: that with the largest modal assurance criterion to the last.
        """
        if self.kind.value != RUN and self.kind.value not in STATES:
            raise ConfigurationError(f"picture of {self.kind.value[:80]!r}: must be {', '.join((RUN, *STATES))}")
        state = STATES.get(self.kind.value)
        for handle, of_modes in ((self.mode, True), (self.amplitude, True), (self.slower, False), (self.larger, False)):
            handle.visible = of_modes is (state is not None)
        self._car, self.modes = car, []
        if state is None:
            motion = car_motion(car, self.drive)
            self.larger.value = self.stage.show(car, motion, slower=_limited(self.slower), larger=self._enlarged)
            return
        self.modes = [mode for mode in car.modes(state) if mode.frequency > 0.0 and not mode.grows]
        if not self.modes:
            raise ConfigurationError("this car has no mode up to 60 Hz")
        self.stage.car_scene.update(car)
        index = int(np.argmax([ride_share(mode) for mode in self.modes]))
        if self._chosen is not None:
            index = int(np.argmax(mac([self._chosen], [self._displacement(mode) for mode in self.modes])))
        self.mode.options = [
            f"{number}: {mode.frequency:.2f} Hz, {100.0 * mode.damping_ratio:.1f} %, {mode.description}"
            for number, mode in enumerate(self.modes, 1)
        ]
        self.mode.value = self.mode.options[index]
        self._animate(index)

    def _displacement(self, mode: Mode) -> Complex:
        """Return the displacement of the points of the car in a mode; (n, 3)."""
        return self.stage.car_scene.wire.displacement(self._shape(mode))

    def _shape(self, mode: Mode) -> Complex:
        assert self._car is not None
        return self._car.geometry_motion(mode.shape)

    def _choose(self) -> None:
        """Show the mode of the list."""
        if self.mode.value not in self.mode.options:
            raise ConfigurationError(f"mode {self.mode.value[:80]!r}: must be one of the modes in the list")
        if self.modes:
            self._animate(self.mode.options.index(self.mode.value))

    def _animate(self, index: int) -> None:
        """Show a mode; a cycle of the picture lasts `CYCLE`."""
        assert self._car is not None
        mode = self.modes[index]
        self._chosen = self._displacement(mode)
        motion = mode_motion(self.stage.car_scene.wire, self._shape(mode), mode.frequency)
        self.stage.show(self._car, motion, slower=CYCLE * mode.frequency, larger=_limited(self.amplitude))

    def _enlarge(self) -> None:
        """Keep an exaggeration that was set on the page."""
        self._enlarged = self.stage.larger = _limited(self.larger)


def _limited(slider: Any) -> float:
    """Return the value of a slider within its range; its minimum for NaN."""
    value = float(slider.value)
    return min(max(value, slider.min), slider.max) if not math.isnan(value) else float(slider.min)
