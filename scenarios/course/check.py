"""Check a solution of an exercise of the course (docs/course): `python -m scenarios.course.check 1.1 "12 mm"`."""

import argparse
from functools import partial

from scenarios.course.lessons import EXERCISES
from vehicle.commands.command_line import parse_and_run
from vehicle.commands.console import Console
from vehicle.commands.options import message_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError


def parser() -> Parser:
    """Return the parser of the options."""
    options = Parser(prog="python -m scenarios.course.check", description=(__doc__ or "").partition(":")[0] + ".")
    options.add_argument("exercise", metavar="EXERCISE", help="number of the exercise, as 1.1")
    options.add_argument("answer", metavar="ANSWER", help="number with its unit, as '12 mm'")
    message_options(options)
    return options


def check(options: argparse.Namespace, console: Console) -> None:
    """Print the verdict on a solution.

    Raises:
        ConfigurationError: unknown number of an exercise.
    """
    if options.exercise not in EXERCISES:
        raise ConfigurationError(f"exercise {options.exercise!r}: must be {', '.join(EXERCISES)}")
    print(f"{options.exercise} {EXERCISES[options.exercise].verdict(options.answer)}")


main = partial(parse_and_run, parser(), check)


if __name__ == "__main__":
    raise SystemExit(main(None))
