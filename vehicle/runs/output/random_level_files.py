"""Files of FRFs at levels of a random input: table, picture and summary."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.digits import aligned, finite, number
from vehicle.drawing.rendering.random_level_plot import plot_random_levels
from vehicle.names import channel_words
from vehicle.runs.car.random_levels import LINEAR_FROM, RandomLevelMap
from vehicle.runs.output.folder import output_folder, write_files, write_json
from vehicle.runs.output.level_files import empty_or
from vehicle.signals.formats.csv_table import table_text


def random_text(states: RandomLevelMap, caption: str) -> str:
    """Return the table of the FRFs as CSV text."""
    heads, columns = ["frequency [Hz]", "level [mm RMS]"], []
    for index, name in enumerate(states.channels):
        unit = states.units[name]
        heads += [f"{name} FRF [({unit})/m]", f"{name} phase [deg]", f"{name} standard error [({unit})/m]",
                  f"{name} distortion [%]", f"{name} linearised FRF [({unit})/m]"]  # fmt: skip
        columns += [np.abs(states.frf[index]), np.degrees(np.angle(states.frf[index])), states.error[index],
                    100.0 * states.distortion[index], np.abs(states.linearised[index])]  # fmt: skip
    rows = [
        [frequency, 1e3 * level, *(empty_or(column[at, row]) for column in columns)]
        for row, level in enumerate(states.level.tolist())
        for at, frequency in enumerate(states.frequency.tolist())
    ]
    return table_text([heads, *rows], [caption], digits=7)


def random_summary(states: RandomLevelMap, files: Sequence[str]) -> dict[str, Any]:
    """Return the content of summary.json."""
    mean, deviation = states.mean_rms
    return {
        "car": states.car.vehicle.name,
        "overrides": list(states.car.overrides),
        "input": states.driven.words,
        "shares": {name: [share.real, share.imag] for name, share in states.driven.shares.items()},
        "spectrum": "flat velocity",
        "band_hz": states.frequency[[0, -1]].tolist(),
        "realisations": states.ended.shape[1],
        "level_mm_rms": (1e3 * states.level).tolist(),
        "channels": list(states.channels),
        "without_result": int(np.sum(~states.ended)),
        "rms": {name: [*map(finite, values.tolist())]
                for name, values in zip(states.channels, mean, strict=True)},
        "rms_standard_error": {name: [*map(finite, values.tolist())]
                               for name, values in zip(states.channels, deviation, strict=True)},
        "slip_share": {name: [*map(finite, values.tolist())]
                       for name, values in zip(states.dampers, states.slip, strict=True)},
        "notices": states.notices,
        "files": list(files),
    }  # fmt: skip


def write_random_levels(
    folder: Path,
    states: RandomLevelMap,
    *,
    force: bool = False,
    figures: bool = True,
    protect: tuple[Path, ...] = (),
) -> list[str]:
    """Write random.csv, a picture of each channel and summary.json, all or none; return the names.

    Args:
        folder: folder of the results.
        states: the FRFs.
        force: replace the files of an earlier run.
        figures: write pictures.
        protect: input files.
    """
    title = f"{states.car.vehicle.name}, {states.driven.words}, random with a flat velocity spectrum"
    caption = (
        f"mean of {states.ended.shape[1]} periodic realisations: best linear approximation; dashed: statistical "
        f"linearisation, from {1e3 * LINEAR_FROM:g} mm on"
    )
    contents: dict[str, Any] = {"random.csv": random_text(states, f"{title}; {caption}")}
    for index, name in enumerate(states.channels if figures and states.ended.any() else ()):
        contents["random.png" if not index else f"random_{name}.png"] = partial(
            plot_random_levels, frequency=states.frequency, level=1e3 * states.level, size=np.abs(states.frf[index]),
            distortion=states.distortion[index], linearised=np.abs(states.linearised[index]),
            label=f"{channel_words(name)} / plate [({states.units[name].replace('m/s2', 'm/s²')})/m]",
            title=title, caption=caption,
        )  # fmt: skip
    files = [*contents, "summary.json"]
    with output_folder(folder, force=force, protect=protect) as work:
        write_files(work, contents)
        write_json(work / "summary.json", random_summary(states, files))
    return files


def printed_random(states: RandomLevelMap, folder: Path, files: Sequence[str]) -> str:
    """Return the printed summary."""
    (name, *_), (mean, deviation) = states.channels, states.mean_rms
    unit = states.units[name]
    heads = ("level [mm RMS]", f"RMS [{unit}]", "+-", "distortion [%]",
             *(f"slip {damper.removeprefix('damper_')} [%]" for damper in states.dampers))  # fmt: skip
    # The scatter of the whole response over its mean part, weighted with the spectrum of the input.
    weight = states.frequency[:, None] ** -2.0
    with np.errstate(invalid="ignore"):
        whole = np.sqrt(np.sum(weight * states.scatter[0] ** 2, axis=0)
                        / np.sum(weight * np.abs(states.frf[0]) ** 2, axis=0))  # fmt: skip
    table = [
        [number(1e3 * level), *(number(finite(value)) for value in (
            mean[0, row], 2.0 * deviation[0, row], 100.0 * whole[row], *(100.0 * states.slip[:, row])))]
        for row, level in enumerate(states.level.tolist())
    ]  # fmt: skip
    return "\n".join([
        f"{states.car.vehicle.name}, {states.driven.words}; random, flat velocity {states.frequency[0]:g} to "
        f"{states.frequency[-1]:g} Hz, {states.ended.shape[1]} realisations",
        f"{channel_words(name)}:",
        *aligned([heads, *table], left=0),
        f"files: {folder}: {', '.join(files)}",
    ])  # fmt: skip
