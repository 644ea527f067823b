"""State of the bench: base car, changed parameters, and the numbers of the reference A and of the present car B."""

import threading
from collections.abc import Callable, Sequence
from dataclasses import replace

from vehicle.errors import ConfigurationError, VehicleError
from vehicle.handover.bench.drive import BenchDrive
from vehicle.handover.bench.numbers import BenchNumbers, numbers
from vehicle.handover.bench.setting import Setting, settings
from vehicle.runs.car import Car

HALVINGS = 7
"""Bisections of the range of a slider: its end is accurate to 1 % of the range."""

MOST_FOUND = 50
"""Maximum number of parameters that a search lists."""


class BenchState:
    """Car under sliders with its numbers B, and the numbers of the reference A.

    Args:
        car: the car; the numbers are relative to it.
        drive: input of the bench.
        measure: further figures of the table by their names in the catalogue.

    Attributes:
        car: base car, with the overrides of the drive.
        drive: input of the bench.
        settings: all numbers that a slider can change, by path; without those that the input sets (the speed).
        changes: path to value of the changed parameters.
        present, reference: car and numbers of B and A.
        message: error of the last change; empty without an error.
        computing: lock of all computations: the callbacks of MuJoCo belong to the process.

    Raises:
        VehicleError: the unchanged car cannot be run.
    """

    def __init__(self, car: Car, drive: BenchDrive, measure: Sequence[str] = ()) -> None:
        self.car = car.with_(drive.overrides) if drive.overrides else car
        self.drive, self.measure = drive, tuple(measure)
        fixed = {text.partition("=")[0] for text in drive.overrides}
        self.settings = {path: setting for path, setting in settings(self.car).items() if path not in fixed}
        self.changes: dict[str, float] = {}
        self._narrowed: set[str] = set()
        self.message = ""
        self.computing = threading.Lock()
        # The terms of all variants and the compiled functions are made now, not at the first change.
        numbers(
            self.car.with_([f"{path}={setting.value!r}" for path, setting in list(self.settings.items())[:1]]), drive
        )
        first = numbers(self.car, drive, self.measure)
        self.present: tuple[Car, BenchNumbers] = (self.car, first)
        self.reference: tuple[Car, BenchNumbers] = (self.car, first)

    def search(self, text: str) -> list[str]:
        """Return the paths with all words in path or meaning, at most `MOST_FOUND`."""
        wanted = text.lower().split()
        matches = (
            path
            for path, setting in self.settings.items()
            if all(word in f"{path} {setting.meaning}".lower() for word in wanted)
        )
        return [path for path, _ in zip(matches, range(MOST_FOUND), strict=False)]

    def setting(self, path: str) -> Setting:
        """Return a setting, whose range at its first use is narrowed to values with which the car can be built.

        A moment of inertia, for example, cannot exceed the sum of the two others.
        """
        if path not in self.settings:
            raise ConfigurationError(f"bench: found {path[:80]!r}, must be the path of a number of the car")
        if path not in self._narrowed:
            setting = self.settings[path]
            low, high = (self._last_accepted(setting, end) for end in (setting.low, setting.high))
            if low == high:
                self._require(path, setting.high if setting.high != setting.value else setting.low)
            self.settings[path] = replace(setting, low=low, high=high)
            self._narrowed.add(path)
        return self.settings[path]

    def _require(self, path: str, value: float) -> None:
        """Raise a VehicleError if the base car cannot be built with a value, or does not stand."""
        with self.computing:
            _ = self.car.with_([f"{path}={value!r}"]).static

    def _last_accepted(self, setting: Setting, end: float) -> float:
        """Return the value nearest to an end of a range with which the car can be built, by bisection."""

        def accepted(value: float) -> bool:
            try:
                self._require(setting.path, value)
            except VehicleError:
                return False
            return True

        if end == setting.value or accepted(end):
            return end
        inside, outside = setting.value, end
        for _ in range(HALVINGS):
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if accepted(middle) else (inside, middle)
        rounded = float(f"{inside:.2g}")  # an end that can be read
        between = min(setting.value, inside) <= rounded <= max(setting.value, inside)
        return rounded if between and rounded != setting.value else inside

    def change(self, path: str, value: float) -> None:
        """Change a number of the car; `update` computes."""
        setting = self.setting(path)
        if not setting.accepts(value):
            raise ConfigurationError(
                f"{path}: found {value!r} {setting.unit}, must be {setting.low:g} to {setting.high:g} {setting.unit}"
            )
        changes = {**self.changes, path: float(value)}
        # The value of the file is no change, so the car stays bitwise equal.
        if abs(value - setting.value) < 0.5 * setting.step:
            del changes[path]
        self.changes = changes

    def update(self) -> bool:
        """Compute the numbers of the changed car; on an error, keep the last numbers and set `message`.

        Returns:
            True if there are new numbers.
        """
        try:
            changes = {path: repr(value) for path, value in self.changes.items()}
            car = self.car.with_([f"{path}={text}" for path, text in changes.items()]) if changes else self.car
            with self.computing:
                self.present = (car, numbers(car, self.drive, self.measure))
        except VehicleError as error:
            self.message = str(error)
            return False
        except Exception as error:  # a car under sliders may fail anywhere, and the next change must be computed
            self.message = f"this car cannot be computed ({error}); move the slider back"
            return False
        self.message = ""
        return True

    def keep(self) -> None:
        """Keep the present numbers as the reference A."""
        self.reference = self.present

    def reset(self) -> None:
        """Undo all changes; `update` computes."""
        self.changes = {}

    def rows(self) -> list[tuple[str, float, float, str]]:
        """Return name, A, B and unit of each number."""
        before = self.reference[1].table
        return [(name, before[name][0], value, unit) for name, (value, unit) in self.present[1].table.items()]


class LatestOnly:
    """Worker thread that computes after a request; requests during a computation cause a single new computation.

    Args:
        job: computation; its errors must be caught in it.
    """

    def __init__(self, job: Callable[[], None]) -> None:
        self._job, self._asked, self._ended = job, threading.Event(), False
        self.runs = 0
        self._thread = threading.Thread(target=self._work, name="bench numbers", daemon=True)
        self._thread.start()

    def request(self) -> None:
        """Request a computation with the current values."""
        self._asked.set()

    @property
    def pending(self) -> bool:
        """True if a newer request waits."""
        return self._asked.is_set()

    def stop(self) -> None:
        """End the thread after the present computation."""
        self._ended = True
        self._asked.set()
        self._thread.join()

    def _work(self) -> None:
        while True:
            self._asked.wait()
            self._asked.clear()
            if self._ended:
                return
            self._job()
            self.runs += 1
