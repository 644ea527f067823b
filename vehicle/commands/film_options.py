"""Options of films of runs, and their checks."""

import argparse
import math
from collections.abc import Mapping
from typing import Any

from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError


def film_options(parser: Parser, content: str) -> argparse._ActionsContainer:
    """Add --video and the settings of a film.

    Args:
        parser: parser of the command.
        content: help of --video.

    Returns:
        The group of the settings.
    """
    parser.add_argument("--video", nargs="?", const="", metavar="FILE.mp4", help=content)
    film = parser.scoped_group("a film", needs="--video", active=lambda options: options.video is not None)
    film.add_argument(
        "--video-start",
        type=float,
        metavar="S",
        help="start of the film in the record [s]; default: chosen by the program",
    )
    film.add_argument(
        "--video-duration",
        type=float,
        metavar="S",
        help="length of the film [s]; default: 10, less for a bump or an obstacle. A film in slow motion shows a "
        "shorter part of the record",
    )
    film.add_argument(
        "--slow-motion",
        type=float,
        metavar="N",
        help="play N times slower; default: 1, at least 4 for a bump or an obstacle, and more if a wheel moves faster "
        "than 15 Hz; --video-start and --video-duration do not change it",
    )
    film.add_argument(
        "--exaggeration", type=float, metavar="N", help="show the motion N times larger; default: chosen by the program"
    )
    return film


def check_film_options(options: argparse.Namespace) -> None:
    """Check the numbers of a film before anything is computed.

    Raises:
        ConfigurationError: a number is out of range.
    """
    wanted = (
        ("--slow-motion", options.slow_motion, 1.0, "at least 1"),
        ("--video-duration", options.video_duration, 0.1, "at least 0.1 s"),
        ("--exaggeration", options.exaggeration, 1e-3, "at least 0.001"),
        ("--video-start", options.video_start, 0.0, "at least 0 s"),
    )
    for name, value, lowest, allowed in wanted:
        if value is not None and not lowest <= value < math.inf:
            raise ConfigurationError(f"{name} {value:g}: must be a finite number, {allowed}")
    mode = getattr(options, "video_mode", None)
    if mode is not None and (mode <= 0.0 or math.isinf(mode)):
        raise ConfigurationError(f"--video-mode {mode:g}: must be a frequency above 0 Hz, as --video-mode 28")


def take_settings(options: argparse.Namespace) -> Mapping[str, Any]:
    """Return the chosen settings of a `Take`."""
    return {
        "start": options.video_start,
        "duration": options.video_duration,
        "slow": options.slow_motion,
        "exaggeration": options.exaggeration,
    }
