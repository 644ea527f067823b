"""Errors of the package: one base class, one exit code for each class."""

from collections.abc import Mapping
from typing import Any

from vehicle.wording import in_words


class VehicleError(Exception):
    """Base class of all errors; the message contains the fault, its location, the value, the limits and the remedy."""

    exit_code = 4

    def __str__(self) -> str:
        """Return the message, with options in a command and with arguments in Python."""
        return in_words(super().__str__())


class ConfigurationError(VehicleError):
    """Error for a wrong parameter, argument, option or path."""

    exit_code = 2


class DataError(VehicleError):
    """Error for bad data in an input file (signal, modal model, measurement)."""

    exit_code = 3


class SimulationError(VehicleError):
    """Error for a failed simulation, whose results are invalid.

    Args:
        message: see `VehicleError`.
        state: last good state, name to array; None if there is none.
    """

    exit_code = 4

    def __init__(self, message: str, state: Mapping[str, Any] | None = None) -> None:
        super().__init__(message)
        self.state = state


class MissingPartError(VehicleError):
    """Error for a missing library or program."""

    exit_code = 5


class OutputError(VehicleError):
    """Error for a result that cannot be written."""

    exit_code = 6
