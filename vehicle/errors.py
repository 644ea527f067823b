"""Every error a user can meet: one base class, one exit code for each kind."""

from collections.abc import Mapping
from typing import Any


class VehicleError(Exception):
    """Any error of this package: what is wrong, where, the value, what is allowed and the remedy, in one message."""

    exit_code = 4


class ConfigurationError(VehicleError):
    """A parameter, an argument, an option or a path is wrong."""

    exit_code = 2


class DataError(VehicleError):
    """An input file (signal, modal model, measurement) holds bad data."""

    exit_code = 3


class SimulationError(VehicleError):
    """The simulation could not be carried through; no result may be used.

    Args:
        message: as of `VehicleError`.
        state: the last good state, name to array, where there is one.
    """

    exit_code = 4

    def __init__(self, message: str, state: Mapping[str, Any] | None = None) -> None:
        super().__init__(message)
        self.state = state


class MissingPartError(VehicleError):
    """A library or a program that the request needs is not on this machine."""

    exit_code = 5


class OutputError(VehicleError):
    """A result could not be written."""

    exit_code = 6
