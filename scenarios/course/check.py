"""Check a solution of an exercise of the course (docs/course): `python -m scenarios.course.check 1.1 "12 mm"`."""

from dataclasses import dataclass

from scenarios.course.lessons import EXERCISES
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, setting


@dataclass(frozen=True, kw_only=True, slots=True)
class CheckSettings(Settings):
    """Solution of an exercise."""

    exercise: str = setting("number of the exercise, for example 1.1", flag="exercise", metavar="EXERCISE")
    answer: str = setting("number with its unit, for example '12 mm'", flag="answer", metavar="ANSWER")


def parser() -> Parser:
    """Return the parser of the options."""
    options = Parser(prog="python -m scenarios.course.check", description=(__doc__ or "").partition(":")[0] + ".")
    setting_options(options, CheckSettings)
    message_options(options)
    return options


def check(settings: CheckSettings, console: Console) -> None:
    """Print the verdict on a solution.

    Raises:
        ConfigurationError: unknown number of an exercise.
    """
    if settings.exercise not in EXERCISES:
        raise ConfigurationError(f"exercise {settings.exercise!r}: must be {', '.join(EXERCISES)}")
    print(f"{settings.exercise} {EXERCISES[settings.exercise].verdict(settings.answer)}")


main = command(parser, CheckSettings, check)


if __name__ == "__main__":
    raise SystemExit(main(None))
