"""Tables of pandas and data sets of xarray with time histories and FRFs; a MissingPartError without the library."""

import io
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np

from vehicle.engines.simulation.recording import Recording
from vehicle.errors import MissingPartError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.vibration_spectra import ChannelSpectrum


def _library(name: str, purpose: str) -> Any:
    """Import a library of the extra `notebook`."""
    try:
        return import_module(name)
    except ImportError:
        raise MissingPartError(
            f"{purpose} needs {name}, which is not installed; install it with: pip install "
            "'vehicle-on-shaker[notebook]'"
        ) from None


def table_frame(text: str) -> Any:
    """Return a table of CSV text, header in the first line, as a pandas table."""
    return _library("pandas", "to_dataframe").read_csv(io.StringIO(text))


def plain_frame(table: Any) -> Any:
    """Return a pandas table of columns by name, or of rows as mappings."""
    return _library("pandas", "to_dataframe").DataFrame(table)


def recording_frame(recording: Recording) -> Any:
    """Return a pandas table with channels as columns over the time [s], and their units in `attrs["units"]`."""
    pandas = _library("pandas", "to_dataframe")
    frame = pandas.DataFrame(dict(recording.channels), index=pandas.Index(recording.time, name="time [s]"))
    frame.attrs["units"] = dict(recording.units)
    return frame


def recording_dataset(recording: Recording) -> Any:
    """Return an xarray data set with channels as variables over the dimension `time`, each with its unit."""
    xarray = _library("xarray", "to_xarray")
    time = ("time", recording.time, {"units": "s"})
    variables = {
        name: ("time", values, {"units": recording.units[name]}) for name, values in recording.channels.items()
    }
    return xarray.Dataset(variables, coords={"time": time})


def response_frame(response: FrequencyResponse, names: tuple[str, ...]) -> Any:
    """Return a pandas table of magnitude, phase [deg], coherence and random error of each channel over frequency [Hz].

    Args:
        response: FRFs over the plate displacement [unit of the channel per m]; (channels, frequencies).
        names: names of its channels, the first level of the columns; (channels,).
    """
    columns = {}
    for row, name in enumerate(names):
        values = response.response[row]
        columns[name, "magnitude"] = np.abs(values)
        columns[name, "phase"] = np.degrees(np.angle(values))
        columns[name, "coherence"] = response.coherence[row]
        columns[name, "random error"] = response.random_error[row]
    return _over_frequency(response.frequency, columns)


def spectra_frame(spectra: Sequence[ChannelSpectrum]) -> Any:
    """Return a pandas table of density and cumulative RMS of each channel over the equal lines of all [Hz]."""
    columns = {}
    for spectrum in spectra:
        columns[spectrum.label, f"density [({spectrum.unit})^2/Hz]"] = spectrum.density
        columns[spectrum.label, f"cumulative RMS [{spectrum.unit}]"] = spectrum.cumulative_rms
    return _over_frequency(spectra[0].frequency, columns)


def _over_frequency(frequency: Vector, columns: dict[tuple[str, str], Vector]) -> Any:
    """Return a pandas table of (channel, value) columns over frequency [Hz]."""
    pandas = _library("pandas", "to_dataframe")
    frame = pandas.DataFrame(columns, index=pandas.Index(frequency, name="frequency [Hz]"))
    frame.columns.names = ["channel", "value"]
    return frame
