"""Page of the bench: sliders, search, plots, table of A and B, and buttons around the moving car."""

import math
import threading
import time as clock
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.digits import number
from vehicle.engines.reduced.validity import REMEDY
from vehicle.errors import VehicleError
from vehicle.handover.bench.curves import damper_curves, density_curves, frf_curves
from vehicle.handover.bench.results import write_car, write_comparison, write_run
from vehicle.handover.bench.setting import Setting
from vehicle.handover.bench.stage import Stage
from vehicle.handover.bench.state import BenchState, LatestOnly
from vehicle.handover.bench.view import View
from vehicle.names import side_of
from vehicle.runs.car import Car
from vehicle.runs.report.differences import difference, parameter_words

FIRST = ("coulomb_friction", "damper.viscous", "main_spring.stiffness", "tyre.stiffness.z", "body.mass")
"""Ends of the paths of the sliders at the start; the first path with each."""

RED, PALE, GREY = "#c0392b", "rgba(192,57,43,0.35)", "#888888"
"""Colours of B, of its band, and of A."""

DECADES = 3e4
"""Highest over lowest value of a logarithmic axis."""


class Page:
    """Page of a state on a viser server.

    Args:
        server: viser server.
        state: state of the bench, with the numbers of the unchanged car.
        folder: folder of the files that a click writes.

    Attributes:
        state, stage, view: what the page shows.
        worker: thread that computes after changes.
        delays: time from a request to its numbers on the page [s].
    """

    def __init__(self, server: Any, state: BenchState, folder: Path) -> None:
        self.server, self.state, self.folder = server, state, folder
        self.stage = Stage(server, state.car, state.drive)
        self.delays: list[float] = []
        self._sliders: dict[str, Any] = {}
        self._lock = threading.RLock()
        self._moved = 0.0
        self._build()
        self._show()
        self._show_picture()
        self.worker = LatestOnly(self._update)

    def _build(self) -> None:
        """Add all elements of the page."""
        gui = self.server.gui
        gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        gui.main_panel.dock_right()
        self._table = gui.add_markdown("")
        self._note = gui.add_markdown("")
        with gui.add_folder("Parameters"):
            for end in FIRST:
                if path := next((path for path in self.state.settings if path.endswith(end)), None):
                    self.add_slider(path)
        self._added = gui.add_folder("Any parameter", expand_by_default=False)
        with self._added:
            search = gui.add_text("search", "", hint="words of the path or the meaning, e.g. strut top")
            paths = gui.add_dropdown(
                "parameter", self._matches(""), hint="points and stiffnesses end with an axis, e.g. .z"
            )
            add = gui.add_button("Add slider")
        with gui.add_folder("Picture"):
            self.view = View(gui, self.stage, self.state.drive)
        self._plots = self._add_plots()
        with gui.add_folder("Reference and files"):
            keep, reset = gui.add_button("Keep as A"), gui.add_button("Undo all changes")
            files = [
                (gui.add_button("Write vehicle file"), write_car),
                (gui.add_button("Write run"), write_run),
                (gui.add_button("Write report of A and B"), write_comparison),
            ]
        self._on(search, lambda: setattr(paths, "options", self._matches(search.value)))
        self.view.connect(self._on, self._show_picture)
        add.on_click(lambda _: self._guarded(lambda: self.add_slider(self.state.setting(paths.value).path, more=True)))
        keep.on_click(lambda _: self._guarded(self._keep))
        reset.on_click(lambda _: self._guarded(self._reset))
        for button, write in files:
            button.on_click(lambda _, write=write: self._guarded(lambda: self._write(write)))

    def _on(self, handle: Any, act: Callable[[], None]) -> None:
        """Call a function after each change of an element in a browser, not after changes by this program."""
        handle.on_update(lambda event: None if event.client_id is None else self._guarded(act))

    def _matches(self, text: str) -> tuple[str, ...]:
        """Return the paths of a search for the list; a message without any, since a list needs an entry."""
        return tuple(self.state.search(text)) or ("no parameter contains these words",)

    def _guarded(self, act: Callable[[], object]) -> None:
        """Handle an event of the page under the lock; show the message of an error."""
        with self._lock:
            try:
                act()
            except VehicleError as error:
                self._say(str(error))
            except Exception as error:  # shown on the page, not as a traceback in the terminal
                self._say(f"{type(error).__name__}: {error}")

    def _say(self, text: str) -> None:
        """Show a message with escaped markup."""
        self._note.content = _escaped(text)

    def add_slider(self, path: str, *, more: bool = False) -> None:
        """Add the slider of a setting, if the page has no slider of this path.

        Args:
            more: add it below the first sliders, for a searched parameter.

        Raises:
            ConfigurationError: an unknown path.
        """
        if path in self._sliders:
            return
        setting = self.state.setting(path)
        unit, scale = _unit(setting)
        low, high, step = (end / scale for end in (setting.low, setting.high, setting.step))

        def add() -> Any:
            hint = f"{path}: {setting.meaning}"
            label = f"{parameter_words(path)} [{unit}]" if unit else parameter_words(path)
            return self.server.gui.add_slider(label, low, high, step, _shown(setting), hint=hint)

        if more:
            with self._added:
                slider = add()
        else:
            slider = add()
        self._sliders[path] = slider
        self._on(slider, lambda: self._change(path))

    def _change(self, path: str) -> None:
        """Take the value of a slider; put the slider back if the value is outside its range."""
        slider, setting = self._sliders[path], self.state.settings[path]
        value, (_, scale) = slider.value, _unit(setting)
        try:
            if value == _shown(setting):  # the value of the unchanged car, of which the field shows four digits
                self.state.change(path, setting.value)
            else:
                self.state.change(path, value if scale == 1.0 else round(value * scale, 6))
        except VehicleError:
            if slider.value is value:  # otherwise a newer value has arrived, whose event follows
                changed = self.state.changes.get(path)
                slider.value = _shown(setting) if changed is None else changed / scale
            raise
        self._request()

    def _request(self) -> None:
        if not self.worker.pending:
            self._moved = clock.monotonic()
        self.worker.request()

    def _keep(self) -> None:
        self.state.keep()
        self._show()

    def _reset(self) -> None:
        self.state.reset()
        for path, slider in self._sliders.items():
            slider.value = _shown(self.state.settings[path])
        self._request()

    def _write(self, write: Callable[[BenchState, Path], Path]) -> None:
        with self.state.computing:
            path = write(self.state, self.folder)
        self._say(f"written: {path}")

    def _update(self) -> None:
        """Compute and show the numbers, then the motion unless a newer change waits; called by the worker."""
        with self._lock:
            moved = self._moved
        if not self.state.update():
            with self._lock:
                self._say(self.state.message)
            return
        with self._lock:
            self._show()
        self.delays.append(clock.monotonic() - moved)
        if not self.worker.pending:
            try:
                self._show_picture()
            except Exception as error:  # the thread goes on with the next change
                with self._lock:
                    self._say(f"picture: {error}")

    def _show_picture(self) -> None:
        """Compute and show the moving picture of B."""
        with self.state.computing:
            self.view.show(self.state.present[0])

    def _show(self) -> None:
        """Write the numbers of A and B on the page."""
        state = self.state
        (car, present), (other, reference) = state.present, state.reference
        lines = ["| | A | B | change |", "|---|---|---|---|"]
        for name, a, b, unit in state.rows():
            change = "" if math.isnan(a) or math.isnan(b) else difference(a, b, unit)
            # Long words in the last column would break the names into one word a line.
            change = change.replace("percentage ", "").replace(" ", "\u00a0")
            lines.append(f"| {self._words(name)} [{unit}] | {_short(a)} | {_short(b)} | {change} |")
        texts = [_escaped(self._changed(shown)) for shown in (car, other)]
        label = f"{_escaped(state.drive.label)}; computed in {1e3 * present.seconds:.0f} ms"
        lines.append(f"\n**A** {texts[1]} · **B** {texts[0]}\n\n{label}")
        with self.server.atomic():
            self._table.content = "\n".join(lines)
            for plot, curves in self._plots:
                plot.data = curves(present, reference)
            self._note.content = ""
            if present.warnings:
                warnings = "; ".join(text.removesuffix(REMEDY) for text in present.warnings)
                self._say(
                    f"outside the valid range of the reduced engine: {warnings}; save the vehicle file and run "
                    "it with --engine mujoco"
                )

    def _words(self, row: str) -> str:
        """Return the name of a row; a damper without friction is fast, and does not slip, so its velocity is named."""
        _, slip, wheel = row.rpartition("slip ")
        vehicle = self.state.car.vehicle
        return f"above {1e3 * vehicle.slip_velocities[wheel]:g} mm/s, {side_of(wheel, vehicle.wheels)}" if slip else row

    def _changed(self, car: Car) -> str:
        """Return what differs from the car of the start, in words."""
        changes = [text.partition("=") for text in car.overrides[len(self.state.car.overrides) :]]
        texts = []
        for path, _, value in changes:
            unit, scale = _unit(self.state.setting(path))
            texts.append(f"{parameter_words(path)} {number(float(value) / scale, 5)} {unit}".rstrip())
        return ", ".join(texts) or "unchanged"

    def _add_plots(self) -> list[tuple[Any, Callable[..., Any]]]:
        """Add the plots; return each with the function of its curves."""
        uplot, gui = import_module("viser.uplot"), self.server.gui
        both = self.state.present[1], self.state.reference[1]
        wheel = next(iter(self.state.drive.inputs.samples))
        wheel = wheel if wheel in both[0].damper_velocity else next(iter(both[0].damper_velocity))

        def line(label: str, colour: str, width: float) -> Any:
            return uplot.Series(label=label, stroke=colour, width=width, points={"show": False}, spanGaps=True)

        def logarithmic(values: Any) -> dict[str, Any]:
            top = 3.0 * float(values.max())
            return {
                "x": uplot.Scale(time=False, distr=3, range=(1.0, 50.0)),
                "y": uplot.Scale(distr=3, range=(top / DECADES, top)),
            }

        axis = uplot.Series(label="f [Hz]")
        force = 1.5 * float(np.abs(both[0].damper_force[wheel]).max())
        plots: list[tuple[Any, Callable[..., Any]]] = []
        shown = (
            (
                "FRF seat rail z [m/s² per m] against frequency [Hz], 95 % band",
                frf_curves,
                (axis, line("B", RED, 2), line("low", PALE, 1), line("high", PALE, 1), line("A", GREY, 1)),
                logarithmic(frf_curves(*both)[1]),
            ),
            (
                "PSD seat rail z [(cm/s²)²/Hz] against frequency [Hz]",
                density_curves,
                (axis, line("B", RED, 2), line("A", GREY, 1)),
                logarithmic(density_curves(*both)[1]),
            ),
            (
                f"{side_of(wheel, self.state.car.vehicle.wheels)} damper: force [N] against velocity [m/s]",
                lambda a, b: damper_curves(a, b, wheel),
                (
                    uplot.Series(label="v [m/s]"),
                    *(line(f"B {end}", RED, 2) for end in ("low", "high")),
                    *(line(f"A {end}", GREY, 1) for end in ("low", "high")),
                ),
                {"x": uplot.Scale(time=False), "y": uplot.Scale(range=(-force, force))},
            ),
        )
        for title, curves, series, scales in shown:
            legend = uplot.Legend(show=False)
            ticks = {"show": False}
            axes = (uplot.Axis(ticks=ticks), uplot.Axis(size=64, ticks=ticks))
            plot = gui.add_uplot(
                curves(*both), series, title=title, scales=scales, axes=axes, legend=legend, height=150
            )
            plots.append((plot, curves))
        return plots

    def close(self) -> None:
        """End the threads of the page."""
        self.worker.stop()
        self.stage.stop()


def _unit(setting: Setting) -> tuple[str, float]:
    """Return the unit of a slider, empty for none, and its factor: the field of a slider shows five digits alone."""
    if setting.high >= 1e5 and setting.unit.startswith("N"):
        return f"k{setting.unit}", 1e3
    return ("mm", 1e-3) if setting.unit == "m" else ("" if setting.unit == "-" else setting.unit, 1.0)


def _shown(setting: Setting) -> float:
    """Return the value of the unchanged car in the unit of the slider, with four digits."""
    return float(f"{setting.value / _unit(setting)[1]:.4g}")


def _escaped(text: str) -> str:
    """Return a text with escaped markup."""
    return "".join(f"\\{sign}" if sign in "\\`*_{}[]<>()#+!|~$" else sign for sign in text)


def _short(value: float) -> str:
    """Return a number with three digits; a dash for NaN."""
    return "–" if math.isnan(value) else f"{value:.3g}"
