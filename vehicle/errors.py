"""Every error a user can meet: one base class, one exit code for each kind."""


class VehicleError(Exception):
    """What went wrong, where, the value found, what is allowed and how to mend it, in one message."""

    exit_code = 4


class ConfigurationError(VehicleError):
    """A parameter, an option or a path of the command is wrong."""

    exit_code = 2


class DataError(VehicleError):
    """An input file (signal, modal model, measurement) holds bad data."""

    exit_code = 3


class SimulationError(VehicleError):
    """The simulation could not be carried through; no result may be used."""

    exit_code = 4


class MissingPartError(VehicleError):
    """A library or a program that the request needs is not on this machine."""

    exit_code = 5


class OutputError(VehicleError):
    """A result could not be written."""

    exit_code = 6
