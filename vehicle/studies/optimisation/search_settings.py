"""Settings of a search, each declared once: for Python, its documentation and the options of `optimise`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehicle.settings import engine_setting, setting, skip_setting
from vehicle.studies.sweeps.sweep_settings import PoolSettings

if TYPE_CHECKING:
    from vehicle.studies.optimisation.problem import Tolerance, Tolerances


def _tolerance(text: str) -> Tolerance:
    """Return the tolerance of the option."""
    from vehicle.studies.optimisation.problem import parsed_tolerance

    return parsed_tolerance(text)


@dataclass(frozen=True, kw_only=True, slots=True)
class SearchSettings(PoolSettings):
    """Settings of a search."""

    maximise: Sequence[str] = setting("an objective to maximise", (), action="append", metavar="NUMBER[@INPUT]")
    limits: Sequence[str] = setting(
        "constraint, e.g. 'travel<=0.06' or 'lowest_load>=0.1', in the unit of the figure; applies to every input by "
        "default; may be repeated",
        (),
        flag="--limit",
        action="append",
        metavar="NUMBER[@INPUT]<=VALUE",
    )
    cars: int = setting("cars to try; default: %(default)s", 2000, within="[8, inf)", type=int, metavar="N")
    population: int = setting(
        "cars in a generation, at least 8; default: %(default)s", 64, within="[8, inf)", type=int, metavar="N"
    )
    seed: int = setting(
        "seed of the search: equal seeds give equal searches; default: %(default)s",
        1,
        flag="--search-seed",
        dest="search_seed",
        within="[0, inf)",
        type=int,
        metavar="N",
    )
    tolerances: Tolerances = setting(
        "path to half the width of the tolerance band of a parameter, whether varied or not: in the unit of the "
        "parameter, or as '15%%'",
        (),
        flag="--tolerance",
        action="append",
        type=_tolerance,
        metavar="PATH=SIZE",
        help="half the width of the tolerance band of a parameter, whether varied or not: in the unit of the "
        "parameter, in percent (15%%), or for a coordinate in m (0.002). May be repeated",
    )
    samples: int | None = setting(
        "cars within the tolerances for each car tried; 8 by default, more where the quantile needs them",
        within="[2, inf)",
        type=int,
        metavar="K",
    )
    quantile: float | None = setting(
        "quantile of the K cars that counts, 0.5 to below 1; 1: the worst car; default: their mean. A quantile Q needs "
        "1/(1 - Q) cars; 64 fresh cars around each named car then show which share reaches its figures",
        within="[0.5, 1]",
        type=float,
        metavar="Q",
    )
    screen: int | None = setting(
        "estimate all cars on road classes without a run, and run the N best with the engine; every run car is shown "
        "beside its estimate",
        within="[1, inf)",
        type=int,
        metavar="N",
    )
    engine: str = engine_setting("reduced")
    skip: float | None = skip_setting()
    check: bool = setting("also run the named cars with MuJoCo and report the difference", False, action="store_true")
