"""Options of films of runs."""

import argparse

from vehicle.commands.options import setting_options
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.film_settings import FilmSettings


def film_options(parser: Parser, content: str) -> argparse._ActionsContainer:
    """Add --video, with `content` as its help, and the settings of a film; return the group of the settings."""
    parser.add_argument("--video", nargs="?", const="", metavar="FILE.mp4", help=content)
    film = parser.scoped_group("a film", needs="--video", active=lambda options: options.video is not None)
    setting_options(film, FilmSettings)
    return film
