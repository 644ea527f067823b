"""Settings of a function and of its command, each declared once: a field of a dataclass with unit, limits and option.

From the declarations come the options of the command (`vehicle.commands.options.setting_options`), their reading
(`read`, in the same place), the checks of the values, and the arguments of the function in Python with their
documentation (`with_settings`).
"""

import inspect
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import field, fields
from functools import update_wrapper
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, overload

from vehicle.errors import ConfigurationError
from vehicle.names import ENGINES

Class = TypeVar("Class", bound=type)
A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")
D = TypeVar("D")
P = ParamSpec("P")
R = TypeVar("R")
S = TypeVar("S", bound="Settings")
S_co = TypeVar("S_co", covariant=True)


def setting(
    meaning: str, default: Any = None, *, flag: str = "", within: str = "", factor: float = 1.0, **option: Any
) -> Any:
    """Declare a field of a class of `Settings`.

    Args:
        meaning: meaning with unit, for the documentation and the help; "%(default)s" stands for the default.
        default: value in Python of a setting that is left out.
        flag: option of the command; by default the name of the field.
        within: interval of the option, for example "(0, 1]" or "[8, inf)"; empty without limits.
        factor: value in Python over value of the option: 0.01 for a percentage.
        option: arguments of `add_argument`, with help if the option has another unit than Python; none for a setting
            without an option.
    """
    declared = {"meaning": meaning, "flag": flag, "within": within, "factor": factor, "option": option}
    return field(default=default, metadata=declared | {"default": default})


def part(settings: Callable[[], A]) -> A:
    """Declare a field with further settings, for example the road in the settings of a run.

    Args:
        settings: class of `Settings`; by default each has its defaults.
    """
    default: A = field(default_factory=settings, metadata={"part": settings})
    return default


FINITE = "(-inf, inf)"
"""Interval of a number without limits: not a number and infinite are refused."""


class Settings:
    """Base of a dataclass of settings, whose values are checked when it is made."""

    __slots__ = ()

    @classmethod
    def declared(cls) -> dict[str, Mapping[str, Any]]:
        """Return the declaration of each setting by name, see `setting`."""
        return {
            each.name: {**each.metadata, "flag": each.metadata["flag"] or f"--{each.name.replace('_', '-')}"}
            for each in fields(cls)  # type: ignore[arg-type]
            if "meaning" in each.metadata
        }

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            ConfigurationError: a value is out of its interval, or no finite number.
        """
        for name, declared in self.declared().items():
            value = getattr(self, name)
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, int | float) and not isinstance(each, bool):
                    number = each if declared["factor"] == 1.0 else each / declared["factor"]
                    require_within(
                        declared["flag"], number, declared["within"] or FINITE, declared["factor"], _unit(declared)
                    )

    def given(self, *, without: tuple[str, ...] = ()) -> dict[str, Any]:
        """Return the settings that are not left at their default, by name.

        Args:
            without: names that are left out.
        """
        return {
            name: value
            for name, declared in self.declared().items()
            if name not in without and (value := getattr(self, name)) != declared["default"]
        }


def _unit(declared: Mapping[str, Any]) -> str:
    """Return the unit in the brackets of a declaration: "Hz" of "frequency [Hz]"; empty without brackets."""
    texts = (declared["option"].get("help", ""), declared["meaning"])
    found = next((found for text in texts if (found := re.search(r"\[([^\]]+)\]", text))), None)
    return found[1] if found and found[1] != "-" else ""


def require_within(flag: str, number: float, within: str, factor: float = 1.0, unit: str = "") -> None:
    """Check a number of an option.

    Args:
        flag: name of the option.
        number: value of the option.
        within: interval, see `setting`.
        factor: 0.01 for a percentage.
        unit: unit of the interval, for the message.

    Raises:
        ConfigurationError: the number is outside.
    """
    low, high = (end.strip() for end in within[1:-1].split(","))
    opened, closed = within[0] == "(", within[-1] == "]"
    above = number > float(low) if opened else number >= float(low)
    if above and (number <= float(high) if closed else number < float(high)):
        return
    if within == FINITE:
        allowed = "a finite number"
    elif closed and not opened:
        allowed = f"{low} to {high}"
    else:
        allowed = f"above {low}" if opened else f"at least {low}"
        if math.isinf(number) and high == "inf":
            allowed += " and finite"
        elif high != "inf":
            allowed += f"{'' if opened else ','} and {'up to' if closed else 'below'} {high}"
    if unit and factor == 1.0 and within != FINITE:
        allowed = allowed.replace(f" {low}", f" {low} {unit}", 1) if high == "inf" else f"{allowed} {unit}"
    text = str(number) if isinstance(number, int) else f"{number:g}"
    raise ConfigurationError(f"{flag} {text}{'' if factor == 1.0 else ' %'}: must be {allowed}")


def finite_numbers(text: str, separator: str) -> list[float]:
    """Return the numbers of the parts of a text; none if a part is no finite number."""
    try:
        numbers = [float(part) for part in text.split(separator)]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []


def pair(flag: str, needed: str, *, above: float | None = None) -> Callable[[str], tuple[float, float]]:
    """Return the reader of two ascending numbers of at least 0, separated by a colon.

    Args:
        flag: name of the option, for the message.
        needed: required form for the message, for example "LOW:HIGH in Hz, for example 3:45".
        above: number above which both are, in place of at least 0.
    """

    def read(text: str) -> tuple[float, float]:
        try:
            low, high = (float(part) for part in text.split(":"))
        except ValueError:
            low = high = 0.0
        if not (0.0 <= low < high and (above is None or low > above)):
            raise ConfigurationError(f"{flag} {text}: must be {needed}")
        return low, high

    return read


def meanings(settings: type[Settings]) -> str:
    """Return a line for each setting with its meaning, for a docstring."""
    return "".join(
        f"\n        {name}: {each['meaning'] % {'default': each['default']}}."
        for name, each in settings.declared().items()
    )


def documented(decorated: Class) -> Class:
    """Add the settings to the attributes at the end of the docstring of a class of `Settings`."""
    decorated.__doc__ = f"{(decorated.__doc__ or '').rstrip()}{meanings(decorated)}\n    "
    return decorated


class _WithSettings(Protocol[P, S_co]):
    """Decorator of a function of one to four arguments and its settings: they become its keyword arguments."""

    @overload
    def __call__(self, function: Callable[[A, S_co], R]) -> Callable[Concatenate[A, P], R]: ...
    @overload
    def __call__(self, function: Callable[[A, B, S_co], R]) -> Callable[Concatenate[A, B, P], R]: ...
    @overload
    def __call__(self, function: Callable[[A, B, C, S_co], R]) -> Callable[Concatenate[A, B, C, P], R]: ...
    @overload
    def __call__(self, function: Callable[[A, B, C, D, S_co], R]) -> Callable[Concatenate[A, B, C, D, P], R]: ...


def with_settings(settings_class: Callable[P, S]) -> _WithSettings[P, S]:
    """Return the decorator that turns the settings of a function, its last argument, into keyword arguments.

    The settings are added to the arguments in the docstring of the function.

    Args:
        settings_class: class of `Settings`.
    """
    assert isinstance(settings_class, type) and issubclass(settings_class, Settings)
    attributes, further = meanings(settings_class), inspect.signature(settings_class).parameters.values()

    def decorate(function: Callable[..., R]) -> Callable[..., R]:
        signature = inspect.signature(function)
        *first, _ = signature.parameters.values()
        count, names = len(first), [each.name for each in first]

        def with_keywords(*arguments: Any, **keywords: Any) -> R:
            named = {name: keywords.pop(name) for name in names[len(arguments) :] if name in keywords}
            return function(*arguments[:count], **named, settings=settings_class(*arguments[count:], **keywords))

        update_wrapper(with_keywords, function)
        with_keywords.__signature__ = signature.replace(parameters=[*first, *further])  # type: ignore[attr-defined]
        head, arguments, after = (function.__doc__ or "").partition("    Args:\n")
        lines, blank, end = after.partition("\n\n")
        with_keywords.__doc__ = f"{head}{arguments}{lines}{attributes}{blank}{end}"
        return with_keywords

    return decorate


def engine_setting(default: str) -> Any:
    """Declare the engine of the runs of a function or a command; the default is "auto" for many runs."""
    return setting(
        "mujoco: complete nonlinear model; reduced: 3 times faster for a run, tens of times for sweeps, with all force "
        "laws but linear geometry, no video; auto: reduced in its valid range, otherwise mujoco; default: %(default)s",
        default,
        choices=ENGINES,
    )


def stated_errors_setting() -> Any:
    """Declare the switch for the errors that a run with the reduced engine states."""
    return setting(
        "state the errors of the reduced engine from its linear geometry",
        True,
        flag="--no-stated-errors",
        action="store_false",
        help="do not compute the errors of the reduced engine from its linear geometry: up to 60 %% of a run's time",
    )


def skip_setting() -> Any:
    """Declare the start of the evaluation, see `vehicle.signals.excitation.evaluation_start`."""
    return setting(
        "start the evaluation (comfort, SEAT, slip shares, densities) S seconds into the run; default: 0 with --input, "
        "2 on a road, which rises from rest during the first second (more below 19 km/h)",
        within="[0, inf)",
        type=float,
        metavar="S",
    )
