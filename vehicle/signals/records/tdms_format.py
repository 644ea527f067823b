"""TDMS files of LabVIEW."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, clock_step, uniform_axis
from vehicle.signals.records.reader import digest, extra

NO_DATE = 1904
"""Year of the start time of a waveform that has none."""


@contextmanager
def _remarks() -> Iterator[list[str]]:
    """What the library would only log: an incomplete segment, a text that is none. The file lacks data then."""
    found: list[str] = []
    handler = logging.Handler()
    handler.emit = lambda record: found.append(record.getMessage())  # type: ignore[method-assign]
    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.split(".")[0] == "nptdms"]
    before = [(one, one.handlers[:], one.propagate) for one in loggers]
    for one in loggers:
        one.handlers[:], one.propagate = [handler], False
    try:
        yield found
    finally:
        for one, handlers, propagate in before:
            one.handlers[:], one.propagate = handlers, propagate


def read(path: Path) -> Measurement:
    """Read all channels of numbers; the length is that of the data, never `wf_samples`.

    Raises:
        MissingPartError: npTDMS is not installed.
        DataError: damaged, cut off, or without numbers.
    """
    nptdms = extra("nptdms", "tdms", "a TDMS file")
    found: list[Channel] = []
    left, start = 0, ""
    try:
        with warnings.catch_warnings(), _remarks() as remarks:
            warnings.simplefilter("error")
            file = nptdms.TdmsFile.read(path)
        if remarks:
            raise ValueError(remarks[0][:120])
        for group in file.groups():
            for one in group.channels():
                values = np.asarray(one[:])
                if values.dtype.kind not in "fiuc" or values.ndim != 1 or not values.size:
                    left += 1
                    continue
                step = one.properties.get("wf_increment")
                axis, remark = None, ""
                if isinstance(step, float) and step > 0.0:
                    step, remark = clock_step(step)
                    axis = uniform_axis(values.size, step, float(one.properties.get("wf_start_offset") or 0.0))
                date = one.properties.get("wf_start_time")
                if not start and date is not None and not str(date).startswith(str(NO_DATE)):
                    start = str(date)
                unit = one.properties.get("unit_string") or one.properties.get("NI_UnitDescription") or ""
                found.append(
                    Channel(
                        name=one.name,
                        values=values.astype(complex if values.dtype.kind == "c" else np.float64),
                        unit=str(unit),
                        axis=axis,
                        place=group.name,
                        remark=remark,
                    )
                )
    except Exception as error:  # damaged files raise what they like
        raise DataError(
            f"{path}: no TDMS file that can be read ({error}); it may be cut off; export it again"
        ) from None
    if not found:
        raise DataError(f"{path}: no channel of numbers; {left} of other kinds")
    return Measurement(
        path=path,
        format="tdms",
        channels=tuple(found),
        sha256=digest(path),
        program=str(file.properties.get("name") or ""),
        start=start,
        notices=(f"{left} channels hold no numbers",) if left else (),
    )
