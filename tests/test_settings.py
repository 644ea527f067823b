"""Settings of functions and commands: one declaration for Python, its documentation, the checks and the options."""

import inspect
import math
import re
from dataclasses import MISSING, fields
from importlib import import_module

import pytest

import vehicle
from vehicle.commands import COMMANDS, module_of
from vehicle.commands.options import read
from vehicle.errors import ConfigurationError
from vehicle.settings import FINITE, Settings, require_within
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.replication.drive_settings import DriveSettings
from vehicle.studies.sweeps.sweep_settings import SobolSettings, SweepSettings
from vehicle.studies.tuning.fit_settings import HistorySettings, ResponseSettings

DECLARED: dict[str, tuple[type[Settings], str]] = {
    "sweep": (SweepSettings, "sweep"),
    "sobol": (SobolSettings, "sweep"),
    "replicate_drive": (DriveSettings, "drive"),
    "measured_responses": (ResponseSettings, "tune"),
    "measured_histories": (HistorySettings, "tune"),
    "optimise": (SearchSettings, "optimise"),
}
"""Public function to its settings and the command that has their options."""

OF_PYTHON_ALONE = {"executor", "progress", "notice", "measure", "folder", "base"}
"""Settings that a command gives another value than that of an option of the same meaning."""


def all_settings(base: type[Settings] = Settings) -> list[type[Settings]]:
    """Return the classes of settings of all commands."""
    for command in COMMANDS:
        import_module(module_of(command)).parser()
    return [each for below in base.__subclasses__() for each in (below, *all_settings(below))]


NUMBERS = {
    (each["flag"], each["within"]): (settings, name)
    for settings in all_settings()
    for name, each in settings.declared().items()
    if each["option"].get("type") in (int, float)
}
"""Option and interval of a number to the settings that declare it, for all commands."""

UNLIMITED = {"--from", "--to"}
"""Options without limits: a time of a file may be negative."""


@pytest.mark.parametrize(("flag", "within"), NUMBERS)
def test_a_number_of_a_command_is_refused_with_option_value_and_interval(flag, within):
    settings, name = NUMBERS[flag, within]
    assert within or flag in UNLIMITED, f"{flag}: needs an interval"
    factor = settings.declared()[name]["factor"]
    low, high = (float(end) for end in (within or FINITE)[1:-1].split(","))
    outside = [float("nan"), float("-inf"), *([] if within.endswith("]") else [float("inf")])]
    outside += [value for value in (low - 1.0, high + 1.0) if math.isfinite(value)]
    for value in outside:
        required = {each.name: () for each in fields(settings) if each.default is MISSING is each.default_factory}  # type: ignore[arg-type]
        with pytest.raises(
            ConfigurationError, match=rf"^{flag} {value:g}( %)?: must be (above|at least|a finite|{low:g})"
        ):
            settings(**required, **{name: factor * value})


@pytest.mark.parametrize("name", DECLARED)
def test_a_function_has_the_declared_settings_with_their_defaults(name):
    settings, command = DECLARED[name]
    function, made = getattr(vehicle, name), settings()
    arguments, parser = inspect.signature(function).parameters, import_module(f"vehicle.commands.{command}").parser()
    text, document = " ".join(parser.format_help().split()), inspect.getdoc(function) or ""
    for setting, declared in settings.declared().items():
        assert arguments[setting].default == getattr(made, setting)
        assert re.search(rf"^    {setting}: \w", document, re.MULTILINE), setting
        if declared["option"] and setting not in OF_PYTHON_ALONE:
            assert declared["flag"] in text


@pytest.mark.parametrize("name", DECLARED)
def test_the_options_left_out_are_the_defaults_of_python(name):
    settings, command = DECLARED[name]
    needed = {"drive": ["--target", "FILE"], "tune": ["focus"]}.get(command, [])
    options = import_module(f"vehicle.commands.{command}").parser().parse_args(needed)
    assert read(options, settings) == settings()


@pytest.mark.parametrize(
    ("within", "inside", "outside", "words"),
    [
        ("[8, inf)", 8, 7, "at least 8"),
        ("[1, 1000]", 1000, 1001, "1 to 1000"),
        ("(0, 1]", 1, 0, "above 0 and up to 1"),
        ("(0, 100)", 99.9, 100, "above 0 and below 100"),
        ("[1, 1000)", 1, 1000, "at least 1, and below 1000"),
    ],
)
def test_a_number_is_held_to_its_interval(within, inside, outside, words):
    require_within("--number", inside, within)
    for wrong in (outside, float("nan")):
        with pytest.raises(ConfigurationError, match=rf"^--number {wrong:g}: must be {words}$"):
            require_within("--number", wrong, within)


def test_settings_are_checked_when_they_are_made():
    with pytest.raises(ConfigurationError, match=r"^--jobs 0: must be at least 1$"):
        SweepSettings(jobs=0)
    with pytest.raises(ConfigurationError, match=r"^--search-seed -1234567: must be at least 0$"):
        SearchSettings(seed=-1234567)
    with pytest.raises(ConfigurationError, match=r"^--target-error 100 %: must be above 0 and below 100$"):
        DriveSettings(target_error=1.0)
    with pytest.raises(TypeError, match="jbos"):
        vehicle.sweep(vehicle.Car.load(), {}, "low.csv", jbos=2)  # type: ignore[call-arg]
    assert issubclass(vehicle.Road, Settings)
