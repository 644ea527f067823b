"""Speed of the crankshaft of a run: a speed, a run-up, or a channel of the file of the plates."""

from dataclasses import replace

from vehicle.errors import ConfigurationError
from vehicle.settings import finite_numbers
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.input_settings import DriveInput, PlateSettings

Input = PlateSettings | DriveInput

RPM = "rpm="
"""Begin of the channel of the plates that is the speed of the crankshaft."""


def crank_overrides(rpm: str, duration: float | None) -> list[str]:
    """Return the changed parameters of the car for the speed of the crankshaft.

    Args:
        rpm: speed as "750", or run-up as "700:3000" [1/min].
        duration: length of a run-up [s].

    Raises:
        ConfigurationError: another form, or a run-up without its length.
    """
    speeds = finite_numbers(rpm, ":")
    if len(speeds) not in (1, 2):
        raise ConfigurationError(
            f"--rpm {rpm!r}: must be a speed, for example 750, or a run-up, for example 700:3000 [1/min]"
        )
    if len(speeds) == 1:
        return [f"crank.rpm={speeds[0]!r}"]
    if duration is None:
        raise ConfigurationError(
            f"--rpm {rpm}: the length of the run-up is missing; give it in seconds, for example --duration 60"
        )
    return [f"crank.rpm={speeds[0]!r}", f"crank.end_rpm={speeds[1]!r}", f"crank.run_up_time={duration!r}"]


def measured_speed(source: Input, rpm: str | None) -> tuple[Input, list[str]]:
    """Return the input without a channel of the crankshaft, and the changed parameters of the car that name it.

    Args:
        rpm: speed that is given without a channel, or None.

    Raises:
        ConfigurationError: the speed is given twice, or the channel is not one of a file of plates from its start.
    """
    channels = [text.removeprefix(RPM) for text in source.record.picks if text.startswith(RPM)]
    if not channels:
        return source, []
    if rpm is not None or len(channels) > 1:
        raise ConfigurationError(
            "--channel rpm=NAME: the crankshaft speed is given twice; leave out --rpm and other channels"
        )
    if isinstance(source, DriveInput) or source.record.first is not None:
        raise ConfigurationError(
            "--channel rpm=NAME: the speed must be a channel of --input FILE, used from its start; leave out "
            "--from, or name another file with --set crank.file and crank.channel"
        )
    others = tuple(text for text in source.record.picks if not text.startswith(RPM))
    file = find_input(source.input).resolve().as_posix()
    overrides = [f"crank.file={file}", *([f"crank.channel={channels[0]}"] if channels[0] else [])]
    return replace(source, record=replace(source.record, picks=others)), overrides
