"""Damage of a schedule of runs, each repeated, and its ratio to the damage of a reference run.

    D_i = T_i A_i^k,    D = sum n_i D_i,    A = (D / sum n_i T_i)^(1/k)

A_i is the equivalent amplitude of a run of length T_i, one cycle a second of equal damage, k the slope of the Woehler
curve and n_i the number of repeats. Damages add up after Palmgren and Miner; only their ratios have a meaning here.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.load_spectrum import LoadSpectrum


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CountedRun:
    """Loads of a run.

    Attributes:
        name: name of the run.
        duration: its length T [s].
        loads: channel to its spectrum.
    """

    name: str
    duration: float
    loads: Mapping[str, LoadSpectrum]

    def damage(self, channel: str, slope: float) -> float:
        """Return D = T A^k of a channel, in its unit to the power k times s."""
        return float(self.duration * self.loads[channel].equivalent_amplitude ** slope)


@dataclass(frozen=True, kw_only=True, slots=True)
class ScheduledLoad:
    """Load of a channel over a schedule.

    Attributes:
        name, unit: of the channel.
        equivalent_amplitude: A of the schedule [unit].
        shares: share of each run in the damage [-]; 0 without damage.
        ratio: damage over the damage of the reference run [-]; None without one, or without damage there.
    """

    name: str
    unit: str
    equivalent_amplitude: float
    shares: tuple[float, ...]
    ratio: float | None


def scheduled_loads(
    runs: Sequence[CountedRun], repeats: Sequence[float], slope: float, reference: CountedRun | None = None
) -> list[ScheduledLoad]:
    """Return the loads of the channels that all runs have, in the order of the first run.

    Args:
        repeats: number of repeats of each, above 0.
        slope: slope k of the Woehler curve [-].
        reference: reference run; None without one.
    """
    if len(repeats) != len(runs) or not all(0.0 < count < float("inf") for count in repeats):
        raise ConfigurationError(
            f"--repeats: {len(repeats)} numbers for {len(runs)} runs; give a number above 0 for each run"
        )
    every = [*runs, *([] if reference is None else [reference])]
    common = [name for name in runs[0].loads if all(name in run.loads for run in every)]
    if not common:
        raise ConfigurationError(
            f"{', '.join(run.name for run in every)}: these runs have no channel in common; record the same "
            "channels in all runs"
        )
    time = sum(count * run.duration for count, run in zip(repeats, runs, strict=True))
    rows = []
    for name in common:
        damages = [count * run.damage(name, slope) for count, run in zip(repeats, runs, strict=True)]
        total, against = sum(damages), 0.0 if reference is None else reference.damage(name, slope)
        rows.append(
            ScheduledLoad(
                name=name,
                unit=runs[0].loads[name].unit,
                equivalent_amplitude=float((total / time) ** (1.0 / slope)),
                shares=tuple(damage / total if total else 0.0 for damage in damages),
                ratio=total / against if against else None,
            )
        )
    return rows
