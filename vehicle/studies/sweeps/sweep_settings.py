"""Settings of a sweep, each declared once: for Python, its documentation and the options of `sweep` and `optimise`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, engine_setting, require_within, setting, skip_setting

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Executor
    from pathlib import Path

    from vehicle.studies.sweeps.measure import MeasureChoice

SHIFT = 0.01
"""Default change of a coordinate [m], by which it is varied instead of a share: a share of it would depend on the
origin. Assumed: a usual step of a study of hardpoints; the sliders of the bench reach five of them."""


SHARE = 0.2
"""Default relative change of a parameter [-]."""


def _jobs(text: str) -> int:
    """Return the number of processes of the option."""
    try:
        number = int(text)
    except ValueError:
        raise ConfigurationError(f"--jobs {text!r}: must be a whole number") from None
    require_within("--jobs", number, "[1, inf)")
    return number


def _executor(text: str) -> Callable[[], Executor]:
    """Return the function of the option that creates an executor."""
    from vehicle.studies.sweeps.executors import executor_factory

    return executor_factory(text)


@dataclass(frozen=True, kw_only=True, slots=True)
class PoolSettings(Settings):
    """Settings of many runs on processes or a cluster; the results do not depend on them."""

    jobs: int | None = setting(
        "processes for independent runs; default %(default)s, None: chosen by the estimated work",
        1,
        within="[1, inf)",
        type=_jobs,
        metavar="N",
        help="processes for independent runs; default %(default)s: no further process is started",
    )
    executor: Callable[[], Executor] | Executor | None = setting(
        "function that returns an executor, used instead of `jobs`; or an executor, which stays open and is not "
        "replaced if it breaks",
        type=_executor,
        metavar="WHERE",
        help="dask://host:port, or module:factory for an executor of your own",
    )
    folder: Path | None = setting(
        "existing folder in which finished runs are stored, so that the next call can use them; None: not stored"
    )
    progress: Callable[[float], None] | None = setting(
        "called with the finished fraction, including stored runs, before the first run and after each task"
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class RunSettings(PoolSettings):
    """Settings of the runs of a sweep."""

    time_limit: float | None = setting(
        "maximum computing time of a run [s]; a run that takes longer fails", within="(0, inf)", type=float, metavar="S"
    )
    retry_failed: bool = setting("run failed rows again", False, action="store_true")
    notice: Callable[[str], None] | None = setting("called with messages, for example that a cluster has no workers")


@dataclass(frozen=True, kw_only=True, slots=True)
class SweepSettings(RunSettings):
    """Settings of a sweep of a car."""

    engine: str = engine_setting("auto")
    estimate: bool = setting(
        "estimate each car on a road class without a run, about 2 ms a car if only its dampers differ: comfort, tyre "
        "load and RMS accelerations; a car that the estimate does not cover is a failed row",
        False,
        action="store_true",
    )
    skip: float | None = skip_setting()
    measure: MeasureChoice = setting(
        "figure instead of comfort and slip shares, for example travel, tyre_load, peak:seat_rail_acc_z or "
        "order:1:seat_rail_acc_z; may be repeated",
        action="append",
        metavar="NAME",
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class SobolSettings(SweepSettings):
    """Settings of Sobol indices."""

    base: int = setting("number of base points, a power of two, at least 64; %(default)s by default", 256)


@dataclass(frozen=True, kw_only=True, slots=True)
class EffectSettings(SweepSettings):
    """Settings of the effects of single parameters."""

    share: float = setting("relative change of each parameter [-]; %(default)s by default", SHARE)
    shift: float = setting("change of each coordinate [m], instead of a share; %(default)s by default", SHIFT)
    groups: tuple[str, ...] | list[str] = setting(
        "parameters, e.g. front.damper or viscous; by default all stiffnesses, dampings, friction forces and masses", ()
    )
