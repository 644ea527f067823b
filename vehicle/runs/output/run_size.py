"""Memory and disk that a run needs, stated before it starts."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from vehicle.digits import number
from vehicle.engines.simulation.judgement import require_samples
from vehicle.errors import ConfigurationError

BYTES = {"npz": 8.0, "h5": 8.0, "mf4": 8.0, "mat": 8.0, "uff": 8.0, "rpc": 4.0, "csv": 13.0}
"""Size of a sample of a channel in a file [byte]; csv: nine digits, sign, point and comma."""

BESIDE = 0.3e9
"""Memory of a run in addition to its recording [byte]: program, model, plates and one channel in its evaluation."""

STATED_FROM = 1e9
"""Minimum size that is stated before the run [byte]."""


def run_size(folder: Path, duration: float, rate: float, channels: int, formats: Sequence[str]) -> str:
    """Return a message on the memory and the disk of a run; empty below `STATED_FROM`.

    memory = 8 n c + `BESIDE`, disk = n c (sum of `BYTES` of the formats), with n samples of c channels

    Args:
        folder: folder of the run, which need not exist.
        duration: length of the record [s].
        rate: recorded samples a second [Hz].
        channels: number of recorded channels.
        formats: formats of the time histories, for example "npz".

    Raises:
        ConfigurationError: the recording exceeds half the memory, or the files exceed the free disk.
    """
    samples = duration * rate
    require_samples(samples, channels)
    memory = 8.0 * samples * channels + BESIDE
    disk = samples * channels * sum(BYTES[form] for form in formats)
    there = next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.is_dir())
    free = float(shutil.disk_usage(there).free)
    remedy = "for less, name the channels (--channels), or set a lower solver.record_rate"
    if disk > free:
        raise ConfigurationError(
            f"{folder}: {channels} channels of {samples:.3g} samples need {disk / 1e9:.3g} GB on the disk, must be at "
            f"most the free {free / 1e9:.3g} GB; {remedy}"
        )
    if max(memory, disk) < STATED_FROM:
        return ""
    return (
        f"{channels} channels of {duration:g} s need about {number(memory / 1e9, 2)} GB of memory and "
        f"{number(disk / 1e9, 2)} GB on the disk; {remedy}"
    )
