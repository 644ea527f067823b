"""Read TDMS files of LabVIEW."""

import logging
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import OVER_ANGLE, OVER_DISTANCE, Channel, Measurement, clock_step, uniform_axis
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.units import find_unit

AXES = {"displacement": OVER_DISTANCE, "angle": OVER_ANGLE}
"""Function of a waveform by the quantity of its axis."""

NO_DATE = 1904
"""Year that stands for a missing start time of a waveform."""


@contextmanager
def _remarks() -> Iterator[list[str]]:
    """Collect log messages of npTDMS that indicate missing data, for example an incomplete segment."""
    messages: list[str] = []
    handler = logging.Handler()
    handler.emit = lambda record: messages.append(record.getMessage())  # type: ignore[method-assign]
    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.split(".")[0] == "nptdms"]
    before = [(logger, logger.handlers[:], logger.propagate) for logger in loggers]
    for logger in loggers:
        logger.handlers[:], logger.propagate = [handler], False
    try:
        yield messages
    finally:
        for logger, handlers, propagate in before:
            logger.handlers[:], logger.propagate = handlers, propagate


def _start(properties: Mapping[str, Any]) -> np.datetime64 | None:
    """Return the start time of a waveform; None without one."""
    date = properties.get("wf_start_time")
    return None if date is None or str(date).startswith(str(NO_DATE)) else np.datetime64(date)


def _axis(properties: Mapping[str, Any], count: int, later: float) -> dict[str, Any]:
    """Return axis, kind, function and remark of a waveform: x_i = later + wf_start_offset + i * wf_increment."""
    step = properties.get("wf_increment")
    if not isinstance(step, float) or not step > 0.0:
        return {"axis": None, "remark": ""}
    label = str(properties.get("wf_xunit_string") or "")
    unit = find_unit(label)
    offset = float(properties.get("wf_start_offset") or 0.0)
    if unit is not None and unit.quantity == "frequency":
        axis = uniform_axis(count, step, offset) * unit.factor
        return {"axis": axis, "kind": "frequency", "function": "spectrum", "remark": ""}
    if unit is not None and unit.quantity != "time":
        function = AXES.get(unit.quantity, "time history")
        return {"axis": None, "function": function, "remark": f"the axis is in {label!r}, not a time"}
    factor = 1.0 if unit is None else unit.factor
    step, remark = clock_step(step * factor)
    return {"axis": uniform_axis(count, step, offset * factor + later), "remark": remark}


def read(path: Path) -> Measurement:
    """Read all numeric channels, as long as their data, not as `wf_samples`; errors: see `read_record`."""
    nptdms = extra("nptdms", "tdms", "a TDMS file")
    channels: list[Channel] = []
    skipped, start = 0, ""
    with reading(path, "TDMS", "it may be truncated; export it again"):
        with warnings.catch_warnings(), _remarks() as remarks:
            warnings.simplefilter("error")
            file = nptdms.TdmsFile.read(path)
        if remarks:
            raise ValueError(remarks[0][:120])
        signals = [(group, channel) for group in file.groups() for channel in group.channels()]
        starts = [_start(channel.properties) for _, channel in signals]
        earliest = min((date for date in starts if date is not None), default=None)
        start = "" if earliest is None else str(earliest)
        for (group, channel), date in zip(signals, starts, strict=True):
            with _remarks() as scaling:  # npTDMS warns of a scaling that it cannot apply, and returns raw values
                values = np.asarray(channel[:])
            if values.dtype.kind not in "fiuc" or values.ndim != 1 or not values.size:
                skipped += 1
                continue
            later = 0.0 if date is None or earliest is None else float((date - earliest) / np.timedelta64(1, "s"))
            unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription") or ""
            axis = _axis(channel.properties, values.size, later)
            if date is None and earliest is not None and axis.get("axis") is not None:
                axis["remark"] = "; ".join(
                    filter(
                        None, (axis["remark"], "the start time is missing; the earliest of the other channels is used")
                    )
                )
            if scaling:
                remark = f"raw values with an unknown scaling ({scaling[0]}), so the unit {str(unit)!r} is ignored"
                unit, axis["remark"] = "", remark
            channels.append(
                Channel(
                    name=channel.name,
                    values=values.astype(complex if values.dtype.kind == "c" else np.float64),
                    unit=str(unit),
                    place=group.name,
                    **axis,
                )
            )
    if not channels:
        raise DataError(f"{path}: no channel with numbers, only {skipped} others; export numbers")
    return Measurement(
        path=path,
        format="tdms",
        channels=tuple(channels),
        program=str(file.properties.get("name") or ""),
        start=start,
        notices=(f"{skipped} channels without numbers are ignored",) if skipped else (),
    )
