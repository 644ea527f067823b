"""Memory and disk that a run, or a study of many, needs: stated before it starts."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from vehicle.digits import number
from vehicle.engines.simulation.judgement import require_samples
from vehicle.errors import ConfigurationError
from vehicle.leftovers import say
from vehicle.machine import free_memory, physical_memory

BYTES = {"npz": 8.0, "h5": 8.0, "mf4": 8.0, "mat": 8.0, "uff": 8.0, "rpc": 4.0, "csv": 13.0}
"""Size of a sample of a channel in a file [byte]; csv: nine digits, sign, point and comma."""

BESIDE, OF_SAMPLE = 0.3e9, 280.0
"""Memory of a run in addition to its recording [byte]: program and model; for each sample plates and an evaluation.

Measured peaks of an hour at 1 kHz with the reduced engine [GB], and `run_size`: 44 channels 2.5 and 2.6; 61 channels
3.1 and 3.1.
"""

OF_SAMPLE_IN_MUJOCO = 700.0
"""Least memory of a run in MuJoCo for each sample [byte], with energies; 653 measured with 46 channels, 699 with 3."""

STATED_FROM = 1e9
"""Minimum size that is stated before the run [byte]."""

BASE = 0.17e9
"""Memory of a process with its program and its car [byte]; 0.14e9 to 0.19e9 measured."""

PLATES, PLATES_OF_MUJOCO = 220.0, 450.0
"""Memory of a run for each sample, in addition to its channels [byte]: plates, spectra; in MuJoCo also energies."""

CHANNEL = 22.0
"""Memory of a sample of a channel of a car, with its evaluation [byte].

Measured peaks, 5 channels at 1 kHz [GB], and `batch_memory`: 60 s of 8 cars 0.19 and 0.24; 60 s of 24 cars 0.30 and
0.34; 600 s of 2 cars 0.40 and 0.43; 3600 s of one car 1.15 and 1.36; MuJoCo, 300 s 0.33 and 0.34.
"""

_said: set[tuple[str, float, float]] = set()
"""Sizes that `say_size` stated: a search is many sweeps of one size."""


def run_size(
    folder: Path, duration: float, rate: float, channels: int, formats: Sequence[str], *, reduced: bool
) -> str:
    """Return a message on the memory and the disk of a run; empty below `STATED_FROM`.

    memory = n max(8 c + `OF_SAMPLE`, `OF_SAMPLE_IN_MUJOCO`) + `BESIDE`, disk = n c (sum of `BYTES` of the formats)

    n samples of c channels; the maximum in MuJoCo only

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
    return stated_size(
        folder,
        f"{channels} channels of {duration:g} s",
        samples * max(8.0 * channels + OF_SAMPLE, 0.0 if reduced else OF_SAMPLE_IN_MUJOCO) + BESIDE,
        samples * channels * sum(BYTES[form] for form in formats),
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
    there = next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.is_dir())
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


def batch_memory(samples: float, channels: int, *, cars: int = 1, reduced: bool = True) -> float:
    """Return the memory of a process that simulates and evaluates cars together [byte].

    memory = `BASE` + n (`PLATES` + `CHANNEL` channels cars), with n samples of each channel

    Args:
        samples: number n of samples.
        channels: channels of each car.
        cars: cars of a batch; MuJoCo runs each by itself.
        reduced: False if a car may run with MuJoCo.
    """
    return BASE + samples * ((PLATES if reduced else PLATES_OF_MUJOCO) + CHANNEL * channels * cars)
