"""Read TDMS files of LabVIEW."""

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
"""Year that stands for a missing start time of a waveform."""


@contextmanager
def _remarks() -> Iterator[list[str]]:
    """Collect log messages of npTDMS, such as on an incomplete segment, that indicate missing data."""
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


def read(path: Path) -> Measurement:
    """Read all numeric channels; the length is that of the data, not `wf_samples`.

    Raises:
        MissingPartError: npTDMS is not installed.
        DataError: the file is damaged, truncated, or without numbers.
    """
    nptdms = extra("nptdms", "tdms", "a TDMS file")
    channels: list[Channel] = []
    skipped, start = 0, ""
    try:
        with warnings.catch_warnings(), _remarks() as remarks:
            warnings.simplefilter("error")
            file = nptdms.TdmsFile.read(path)
        if remarks:
            raise ValueError(remarks[0][:120])
        for group in file.groups():
            for channel in group.channels():
                values = np.asarray(channel[:])
                if values.dtype.kind not in "fiuc" or values.ndim != 1 or not values.size:
                    skipped += 1
                    continue
                step = channel.properties.get("wf_increment")
                axis, remark = None, ""
                if isinstance(step, float) and step > 0.0:
                    step, remark = clock_step(step)
                    axis = uniform_axis(values.size, step, float(channel.properties.get("wf_start_offset") or 0.0))
                date = channel.properties.get("wf_start_time")
                if not start and date is not None and not str(date).startswith(str(NO_DATE)):
                    start = str(date)
                unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription") or ""
                channels.append(
                    Channel(
                        name=channel.name,
                        values=values.astype(complex if values.dtype.kind == "c" else np.float64),
                        unit=str(unit),
                        axis=axis,
                        place=group.name,
                        remark=remark,
                    )
                )
    except Exception as error:  # npTDMS raises errors of any type for damaged files
        raise DataError(f"{path}: cannot be read as TDMS ({error}); it may be truncated; export it again") from None
    if not channels:
        raise DataError(f"{path}: no numeric channel; {skipped} channels of other types; export numbers")
    return Measurement(
        path=path,
        format="tdms",
        channels=tuple(channels),
        sha256=digest(path),
        program=str(file.properties.get("name") or ""),
        start=start,
        notices=(f"{skipped} channels without numbers are ignored",) if skipped else (),
    )
