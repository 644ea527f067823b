"""Recordings and FRFs as files: `time.npz`, `time.csv`, `frf.csv`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.analysis.frf import FrequencyResponse
from vehicle.simulation.recording import Recording


def write_time_npz(path: Path, recording: Recording, frame: str) -> None:
    """Write `time` [s] and one float array for each channel; units and frame as texts."""
    units = np.array([f"{name} [{unit}]" for name, unit in recording.units.items()])
    with path.open("wb") as file:
        np.savez_compressed(
            file,
            allow_pickle=False,
            time=recording.time,
            **{name: np.asarray(values) for name, values in recording.channels.items()},
            units=units,
            frame=np.array(frame),
        )


def write_time_csv(path: Path, recording: Recording, frame: str) -> None:
    """Write the channels as text, one row a sample, units in the header."""
    names = list(recording.channels)
    header = ",".join(["time [s]", *(f"{name} [{recording.units[name]}]" for name in names)])
    table = np.column_stack([recording.time, *(recording.channels[name] for name in names)])
    np.savetxt(path, table, fmt="%.9g", delimiter=",", header=f"# frame: {frame}\n{header}", comments="")


def write_frf(path: Path, response: FrequencyResponse, channels: Sequence[str], frame: str) -> None:
    """Write magnitude [m/s2 per m], phase [deg], coherence and random error of every channel; empty where undefined."""
    head = ["frequency [Hz]"]
    columns = [response.frequency]
    for row, channel in enumerate(channels):
        head += [f"{channel}_magnitude", f"{channel}_phase [deg]", f"{channel}_coherence"]
        head.append(f"{channel}_random_error")
        values = response.response[row]
        columns += [np.abs(values), np.degrees(np.angle(values)), response.coherence[row]]
        columns.append(response.random_error[row])
    lines = [
        f"# acceleration over plate displacement, magnitude and its random error (one standard error) in m/s2 per m, "
        f"coherence without unit; "
        f"{response.estimator}; frame: {frame}",
        ",".join(head),
    ]
    for line in np.column_stack(columns):
        lines.append(",".join("" if np.isnan(value) else f"{value:.9g}" for value in line))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
