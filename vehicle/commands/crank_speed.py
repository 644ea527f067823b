"""Speed of the crankshaft of the shaker: --rpm with a speed, a run-up or steady points, or a channel of --input."""

import argparse

from vehicle.commands.destination import is_named
from vehicle.commands.options import finite_numbers
from vehicle.errors import ConfigurationError


def steady_points(options: argparse.Namespace) -> None:
    """Run the command `orders` with the same options."""
    from vehicle.commands import orders

    if options.input:
        raise ConfigurationError("--rpm A:B:STEP: steady points are runs on a road; leave out --input")
    arguments = ["--rpm", options.rpm, "--road", options.road or "level"]
    for name in ("vehicle", "speed", "duration"):
        arguments += [] if getattr(options, name) is None else [f"--{name}", str(getattr(options, name))]
    for text in options.overrides:
        arguments += ["--set", text]
    if "--engine" in options.words:
        arguments += ["--engine", options.engine]
    if is_named(options):
        arguments += ["--output", str(options.output), *(["--force"] if options.force else [])]
    orders.job(orders.parser().parse_args(arguments, argparse.Namespace(words=arguments, held=options.held)))


def crank_overrides(options: argparse.Namespace) -> list[str]:
    """Return the overrides of --rpm, or of --channel rpm=NAME, which is taken out of the channels of plates.

    Raises:
        ConfigurationError: another form, steady points, a run-up without its length, or both options.
    """
    measured = [text.partition("=")[2] for text in options.picks if text.startswith("rpm=")]
    if measured:
        return _measured(options, measured)
    if options.rpm is None:
        return []
    speeds = finite_numbers(options.rpm, ":")
    if len(speeds) not in (1, 2):
        raise ConfigurationError(
            f"--rpm {options.rpm!r}: must be a speed, for example 750, or a run-up, for example 700:3000 [1/min]"
        )
    if len(speeds) == 1:
        return [f"crank.rpm={speeds[0]!r}"]
    if options.duration is None:
        raise ConfigurationError(
            f"--rpm {options.rpm}: the length of the run-up is missing; set it in seconds, for example --duration 60"
        )
    return [
        f"crank.rpm={speeds[0]!r}",
        f"crank.end_rpm={speeds[1]!r}",
        f"crank.run_up_time={options.duration!r}",
    ]


def _measured(options: argparse.Namespace, channels: list[str]) -> list[str]:
    """Return the overrides of a speed in the file of the plates."""
    from vehicle.signals.excitation.input_files import find_input

    if options.rpm is not None or len(channels) > 1:
        raise ConfigurationError(
            "--channel rpm=NAME: the crankshaft speed is given twice; leave out --rpm and other channels"
        )
    if not options.input or options.first is not None:
        raise ConfigurationError(
            "--channel rpm=NAME: the speed must be a channel of --input FILE, used from its start; leave out "
            "--from, or name another file with --set crank.file and crank.channel"
        )
    options.picks = [text for text in options.picks if not text.startswith("rpm=")]
    file = find_input(options.input).resolve().as_posix()
    return [f"crank.file={file}", *([f"crank.channel={channels[0]}"] if channels[0] else [])]
