"""Memory and disk that a run, or a study of many, needs: stated before it starts."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from vehicle.digits import number
from vehicle.engines.simulation.judgement import require_samples
from vehicle.errors import ConfigurationError
from vehicle.leftovers import say
from vehicle.machine import free_memory, physical_memory
from vehicle.mapped_table import scratch_folder, size_in_memory

BYTES = {"npz": 8.0, "h5": 8.0, "mf4": 8.0, "mat": 8.0, "uff": 8.0, "rpc": 4.0, "csv": 13.0}
"""Size of a sample of a channel in a file [byte]; csv: nine digits, sign, point and comma."""

BESIDE, OF_SAMPLE = 0.35e9, 260.0
"""Memory of a run with its files [byte]: program, model and blocks; for each sample plates and an evaluation.

Largest memory of runs of `focus_road` at 1 kHz on four plates, with libraries and pages of the file in memory, and
`run_memory` [GB], with all 61 channels: 600 s, h5 without pictures 0.35 and 0.51; 600 s, 183 channels with
loads 0.48 and 0.51; 1200 s with pictures and report 0.58 and 0.66; an hour, h5 without them 1.12, with them 1.23, and
1.29; MuJoCo, 150 s 0.38 and 0.47.
"""

RECORDED = 64
"""Channels that MuJoCo records at least: all of the car, whichever are kept."""

STATED_FROM = 1e9
"""Minimum size that is stated before the run [byte]."""

BASE = 0.17e9
"""Memory of a process with its program and its car [byte]; 0.14e9 to 0.19e9 measured."""

PLATES = 220.0
"""Memory of a batch for each sample, in addition to its channels [byte]: plates, spectra."""

CHANNEL = 22.0
"""Memory of a sample of a channel of a car, with its evaluation [byte].

Measured peaks, 5 channels at 1 kHz [GB], and `batch_memory`: 60 s of 8 cars 0.19 and 0.24; 60 s of 24 cars 0.30 and
0.34; 600 s of 2 cars 0.40 and 0.43; 3600 s of one car 1.15 and 1.36.
"""

_said: set[tuple[str, float, float]] = set()
"""Sizes that `say_size` stated: a search is many sweeps of one size."""


def run_size(
    folder: Path, duration: float, rate: float, channels: int, formats: Sequence[str], *, reduced: bool
) -> str:
    """Return a message on the memory and the disk of a run; empty below `STATED_FROM`.

    memory: see `run_memory`; disk = n c (sum of `BYTES` of the formats), and the recording if it is in a file there

    Args:
        folder: folder of the run, which need not exist.
        duration: length of the record [s].
        rate: recorded samples a second [Hz].
        channels: number of recorded channels.
        formats: formats of the time histories, for example "npz".
        reduced: False if the car may run with MuJoCo.

    Raises:
        ConfigurationError: the recording exceeds half the memory, or see `stated_size`.
    """
    samples = duration * rate
    require_samples(samples, channels)
    disk, recording = samples * channels * sum(BYTES[form] for form in formats), 8.0 * samples * channels
    if _existing(folder).stat().st_dev == scratch_folder().stat().st_dev:
        disk += recording - size_in_memory(recording)
    return stated_size(
        folder,
        f"{channels} channels of {duration:g} s",
        run_memory(samples, channels, reduced=reduced),
        disk,
        "for less, name the channels (--channels), or choose a lower solver.record_rate",
    )


def stated_size(folder: Path, subject: str, memory: float, disk: float, remedy: str) -> str:
    """Return a message on memory and disk of a computation; empty below `STATED_FROM` if it fits.

    More than the free memory is stated and not refused: other programs, or a cache of files, may give it back.

    Args:
        folder: folder of the files, which need not exist.
        subject: runs that need them, in the plural, as "64 runs".
        memory: largest memory of all processes together [byte].
        disk: size of the files [byte].
        remedy: settings with which it needs less.

    Raises:
        ConfigurationError: more than the memory of the machine, or than the free disk.
    """
    there = _existing(folder)
    for name, needed, limit, where, bound in (
        ("", memory, physical_memory(), "of memory", "the memory of this machine,"),
        (f"{folder}: ", disk, float(shutil.disk_usage(there).free), "on the disk", "the free"),
    ):
        if needed > limit:
            raise ConfigurationError(
                f"{name}{subject} need {needed / 1e9:.3g} GB {where} but may need at most {bound} {limit / 1e9:.3g} "
                "GB; "
                f"{remedy}"
            )
    free = free_memory()
    if max(memory, disk) < STATED_FROM and memory <= free:
        return ""
    more = f" (free now: {number(free / 1e9, 2)} GB)" if memory > free else ""
    sizes = f"{number(memory / 1e9, 2)} GB of memory{more} and {number(disk / 1e9, 2)} GB on the disk"
    return f"{subject} need about {sizes}; {remedy}"


def say_size(folder: Path, subject: str, memory: float, disk: float, remedy: str) -> None:
    """Print the message of `stated_size` as a notice, once in a process; arguments and errors as there."""
    text = stated_size(folder, subject, memory, disk, remedy)
    if text and (subject, memory, disk) not in _said:  # the free memory in the text changes
        _said.add((subject, memory, disk))
        say(text)


def _existing(folder: Path) -> Path:
    """Return the nearest folder that exists, the folder itself or above."""
    return next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.is_dir())


def run_memory(samples: float, channels: int, *, reduced: bool) -> float:
    """Return the memory of a run with its files [byte].

    memory = `BESIDE` + `OF_SAMPLE` n + 8 n c, without the last term if the recording is in a file

    Args:
        samples: number n of samples.
        channels: recorded channels c; in MuJoCo at least `RECORDED`.
        reduced: False if the car may run with MuJoCo.
    """
    recording = 8.0 * samples * (channels if reduced else max(channels, RECORDED))
    return BESIDE + OF_SAMPLE * samples + size_in_memory(recording)


def batch_memory(samples: float, channels: int, *, cars: int = 1, reduced: bool = True) -> float:
    """Return the memory of a process that simulates and evaluates cars together [byte].

    memory = `BASE` + n (`PLATES` + `CHANNEL` channels cars), with n samples of each channel; in MuJoCo `run_memory`

    Args:
        samples: number n of samples.
        channels: channels of each car.
        cars: cars of a batch; MuJoCo runs each by itself.
        reduced: False if a car may run with MuJoCo.
    """
    batch = BASE + samples * (PLATES + CHANNEL * channels * cars)
    return batch if reduced else max(batch, run_memory(samples, channels, reduced=False))
