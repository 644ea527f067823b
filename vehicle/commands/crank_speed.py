"""Option --rpm of the shaker: a speed of the crankshaft, a run-up, or steady points."""

from __future__ import annotations

import argparse
import math

from vehicle.commands.destination import is_named
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
    """Return the overrides of --rpm.

    Raises:
        ConfigurationError: another form, steady points, or a run-up without its length.
    """
    if options.rpm is None:
        return []
    try:
        speeds = [float(part) for part in options.rpm.split(":")]
    except ValueError:
        speeds = []
    if len(speeds) not in (1, 2) or not all(map(math.isfinite, speeds)):
        raise ConfigurationError(f"--rpm {options.rpm!r}: needed is a speed, as 750, or a run-up, as 700:3000 [1/min]")
    if len(speeds) == 1:
        return [f"crank.rpm={speeds[0]!r}"]
    if options.duration is None:
        raise ConfigurationError(f"--rpm {options.rpm}: a run-up needs its length; set --duration S, as 60")
    return [
        f"crank.rpm={speeds[0]!r}",
        f"crank.end_rpm={speeds[1]!r}",
        f"crank.run_up_time={options.duration!r}",
    ]
