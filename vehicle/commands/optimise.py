"""`python -m vehicle optimise`: the parameters with the best compromise, within bounds and limits."""

from __future__ import annotations

import argparse
import math
import shlex
import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.destination import prepared_folder_of
from vehicle.commands.input_options import signal_options
from vehicle.commands.inputs import chosen_inputs, chosen_skip
from vehicle.commands.options import (
    command_parser,
    engine_option,
    executor_option,
    jobs_option,
    message_options,
    output_options,
    skip_option,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.optimisation.closer_look import Differences, Shares
    from vehicle.optimisation.outcome import Outcome
    from vehicle.optimisation.trials import Trials
    from vehicle.parameters.vehicle import Vehicle

STILL = 0.005
"""Share of the hypervolume: a front that grew by more in the last quarter is not at rest."""


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("optimise", "Search for the parameters with the best compromise of comfort, load, travel.")
    signal_options(found, several=True)
    vehicle_options(found)
    search = found.add_argument_group("the search")
    search.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=LOW:HIGH",
        help="a parameter and its bounds, in its unit, as front.damper.viscous=800:4000; *.damper.viscous sets all "
        "that end so alike; may be repeated",
    )
    search.add_argument(
        "--minimise",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]",
        help="an objective: comfort, weighted, seat [m/s2], tyre_load, lowest_load, slip_share [-], travel [m]; one "
        "axis or wheel is comfort_z, travel_fr; behind the @ an input, as road_A_120 or the stem of a file, or mean or "
        "worst of all; may be repeated",
    )
    search.add_argument(
        "--maximise", action="append", default=[], metavar="NUMBER[@INPUT]", help="the same, to be as large as can be"
    )
    search.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]<=VALUE",
        help="what a car must keep, as 'travel<=0.06' or 'lowest_load>=0.1', in the unit of the number; without an "
        "input on every one; may be repeated",
    )
    search.add_argument("--cars", type=int, default=2000, metavar="N", help="cars to try; %(default)s by default")
    search.add_argument(
        "--population",
        type=int,
        default=64,
        metavar="N",
        help="cars of a generation, at least 8; %(default)s by default",
    )
    search.add_argument(
        "--search-seed", type=int, default=1, metavar="N", help="one seed is one search; %(default)s by default"
    )
    found.add_argument(
        "--tolerance",
        action="append",
        default=[],
        metavar="PATH=SIZE",
        help="half of the band of a parameter, varied or not: in its unit, or in percent: 15%%; may be repeated",
    )
    made = found.scoped_group(
        "cars as they are made",
        needs="--tolerance PATH=SIZE, and there is none",
        active=lambda options: bool(options.tolerance),
    )
    made.add_argument(
        "--samples",
        type=int,
        metavar="K",
        help="cars within the tolerances for each car tried; 8 by default, more where the quantile needs them",
    )
    made.add_argument(
        "--quantile",
        type=float,
        metavar="Q",
        help="of their numbers that counts, 0.5 to below 1; 1 is the worst of the K cars; their mean by default. A "
        "quantile Q needs 1/(1 - Q) cars; with it, 64 new cars around each named one show what share reaches its "
        "numbers",
    )
    engine_option(found, "reduced")
    skip_option(found, 2.0)
    jobs_option(found)
    executor_option(found)
    found.add_argument("--check", action="store_true", help="run the named cars with MuJoCo and tell the difference")
    found.add_argument(
        "--beside", type=Path, metavar="DIR", help="another search with these objectives: drawn, and how far it is"
    )
    output_options(found, Path("runs/optimise"))
    found.add_argument("--resume", action="store_true", help="go on in that folder, also with more --cars")
    message_options(found, quiet=True)
    return found


def _job(options: argparse.Namespace) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.optimisation.car_table import CARS
    from vehicle.optimisation.closer_look import (
        NEW_CARS,
        chosen_cars,
        compared,
        left_validity,
        new_cars,
        without_tolerances,
    )
    from vehicle.optimisation.kept_search import kept_search
    from vehicle.optimisation.outcome import outcome
    from vehicle.optimisation.search import pymoo
    from vehicle.optimisation.search_files import agreement, read_beside, write_search
    from vehicle.optimisation.trials import on_executor
    from vehicle.sweeps.case import all_tyre_words, table_cases
    from vehicle.sweeps.executors import executor_factory

    for name, least in (("cars", 8), ("population", 8), ("search_seed", 0)):
        if (number := getattr(options, name)) < least:
            raise ConfigurationError(f"--{name.replace('_', '-')} {number}: must be at least {least}")
    pymoo("core.problem")
    trials, vehicle, skip = _trials(options)
    beside = None if options.beside is None else read_beside(options.beside, trials.problem)
    make = executor_factory(options.executor, options.jobs)
    folder = prepared_folder_of(options, options.output, rows=CARS)
    with ExitStack() as held:
        if options.executor or options.jobs > 1:
            trials = replace(trials, evaluate=on_executor(held.enter_context(make()), trials.measure))
        try:
            progress = ProgressLine("optimise  ", enabled=not options.quiet)
            base, generations = kept_search(
                trials,
                folder,
                cars=options.cars,
                population=options.population,
                seed=options.search_seed,
                progress=progress,
            )
        except KeyboardInterrupt:
            print(f"{folder}: finished generations are kept; --resume goes on", file=sys.stderr)
            raise
        found = outcome(trials.problem, base, generations)
        cars = chosen_cars(trials, found)
        nominal = without_tolerances(trials, found) if options.tolerance else None
        reached = new_cars(trials, found, options.search_seed) if trials.spread.quantile > 0.0 else None
        checked = compared(trials, found) if options.check else None
    notices = left_validity(trials, cars)
    asked = table_cases([], [()], trials.inputs, vehicle=trials.vehicle, fixed=trials.fixed)
    tyres = all_tyre_words(asked)
    write_search(
        folder,
        found,
        cars,
        caption=f"{_caption(options, trials, vehicle, len(found.tried.reasons), tyres)}; evaluated from {skip:g} s on",
        nominal=nominal,
        beside=beside,
        summary={
            "command": f"python -m vehicle optimise {shlex.join(options.words)}",
            "vehicle": vehicle.name,
            "inputs": {source.name: source.identity() for source in trials.inputs},
            "engine": options.engine,
            "tyre": tyres,
            "evaluated_from_s": skip,
            "notices": notices,
            "mujoco": checked,
            "made_cars": None
            if nominal is None
            else {"statistic": trials.spread.words, "new_cars": NEW_CARS if reached else 0, "share_as_good": reached},
        },
    )
    if not options.quiet:
        _tell(folder, found, trials, vehicle, checked, reached)
        print(f"tyres {tyres}; engine {options.engine}; evaluated from {skip:g} s on")
        if beside is not None:
            far = agreement(found, beside)
            print(
                f"front of {beside.folder}: hypervolume {100 * far['hypervolume_change']:+.2f} % against this one, "
                f"mean distance {100 * far['mean_distance']:.2f} % of the extents"
            )
        if notices:
            print(
                f"{len(notices)} notices in summary.json: the reduced engine left its validity; --check tells the cost"
            )


def _trials(options: argparse.Namespace) -> tuple[Trials, Vehicle, float]:
    """Return how cars are tried, the car as it is, and the start of the evaluation [s]."""
    from vehicle.optimisation.problem import parsed_range, parsed_tolerance, parsed_wishes
    from vehicle.optimisation.ride import ride_measure
    from vehicle.optimisation.trials import ALONE, Spread, Trials, bands
    from vehicle.optimisation.variables import problem_of, require_bounds, toleranced
    from vehicle.parameters.vehicle import load_vehicle
    from vehicle.sweeps.evaluation import evaluate

    vehicle = load_vehicle(options.vehicle, options.overrides)
    inputs = chosen_inputs(options, vehicle)
    names = [source.name for source in inputs]
    if len(set(names)) < len(names):
        raise ConfigurationError(f"inputs {', '.join(names)}: two have one name; rename a file, or give each once")
    skip = chosen_skip(options, {source.name: source for source in inputs}, 2.0)
    wishes = parsed_wishes(options.minimise, options.maximise, options.limit, names)
    measure = ride_measure(vehicle, tuple(wish.number for wish in wishes), skip)
    wishes = tuple(replace(wish, unit=measure.units[wish.number]) for wish in wishes)
    problem = problem_of(vehicle, [parsed_range(text) for text in options.vary], wishes, names)
    require_bounds(options.vehicle, options.overrides, problem)
    spread = ALONE
    if options.tolerance:
        quantile, samples = _quantile_and_samples(options)
        tolerances = toleranced(vehicle, [parsed_tolerance(text) for text in options.tolerance])
        places = bands(len(tolerances), samples, options.search_seed)
        spread = Spread(tolerances=tolerances, bands=places, quantile=quantile)
    trials = Trials(
        problem=problem,
        inputs=inputs,
        measure=measure,
        evaluate=evaluate,
        fixed=options.overrides,
        vehicle=options.vehicle,
        engine=options.engine,
        spread=spread,
    )
    return trials, vehicle, skip


def _quantile_and_samples(options: argparse.Namespace) -> tuple[float, int]:
    """Return the quantile, NaN for the mean, and the number of made cars for each car tried.

    Raises:
        ConfigurationError: out of range, or too few cars for the quantile.
    """
    from vehicle.optimisation.trials import samples_for

    quantile = math.nan if options.quantile is None else options.quantile
    if options.quantile is not None and not 0.5 <= quantile <= 1.0:
        raise ConfigurationError(f"--quantile {quantile:g}: allowed are 0.5 to below 1, and 1 for the worst car")
    needed = samples_for(quantile) if quantile < 1.0 else 2
    if options.samples is None:
        return quantile, max(8, needed)
    if options.samples < needed:
        raise ConfigurationError(
            f"--quantile {quantile:g}: needs at least {needed} cars, found --samples {options.samples}; give "
            f"--samples {needed}, a lower quantile, or --quantile 1 for the worst of {options.samples} cars"
        )
    return quantile, options.samples


def _caption(options: argparse.Namespace, trials: Trials, vehicle: Vehicle, cars: int, tyres: str) -> str:
    """What the picture says below it."""
    limits = ", ".join(wish.words for wish in trials.problem.limits)
    count = len(trials.spread.bands)
    return (
        f"{vehicle.name} on {', '.join(trials.problem.inputs)}; tyres {tyres}; engine {options.engine}, {cars} cars, "
        f"seed {options.search_seed}"
        + (f"; limits {limits}" if limits else "")
        + (f"; {trials.spread.words} within the tolerances" if count > 1 else "")
    )


def _tell(
    folder: Path, found: Outcome, trials: Trials, vehicle: Vehicle, checked: Differences | None, reached: Shares | None
) -> None:
    """Print the named cars beside the car as it is."""
    from vehicle.optimisation.car_table import columns
    from vehicle.optimisation.closer_look import NEW_CARS
    from vehicle.parameters.whole_body import body_rules

    problem, tried = found.problem, found.tried
    varied = [*(one.path for one in problem.ranges), *(one.path for one, _ in trials.spread.tolerances)]
    for text in body_rules(vehicle, varied):
        print(f"note        {text}")
    failed = [reason for reason in tried.reasons if reason]
    print(
        f"{folder}: {len(tried.reasons)} cars, {found.whole} on the front, {len(failed)} failed; front.csv, "
        "front.png, summary.json, cars.csv"
    )
    if failed:
        print(f"first failure: {failed[0]}")
    rows = {"base": [*problem.base, *found.base.values[0]]}
    rows |= {name: [*tried.points[row], *tried.values[row]] for name, row in found.named.items()}
    heads = columns(problem)
    width = max(len(head) for head in heads)
    print(" " * width + "".join(f"  {name:>11}" for name in rows))
    for number, head in enumerate(heads):
        print(
            f"{head:<{width}}"
            + "".join(f"  {numbers[number]:{max(len(name), 11)}.5g}" for name, numbers in rows.items())
        )
    if trials.spread.tolerances:
        print(f"each number: {trials.spread.words} within the tolerances")
    for name, shares in (reached or {}).items():
        print(
            f"{name}: of {NEW_CARS} new cars "
            + ", ".join(f"{100 * share:.0f} % are as good in {label}" for label, share in shares.items())
            + f" (standard error {100 * _share_error(trials.spread.quantile, NEW_CARS):.0f} %)"
        )
    if checked is not None:
        for name, each in checked.items():
            said = [f"{label} {100 * one:+.2f} %" for label, one in each.items() if one is not None]
            print(f"MuJoCo, {name}: {', '.join(said)}")
    last = max(found.reached.values(), default=1.0)
    if last < 1.0 - STILL:
        print(f"the front still grew by {100 * (1 - last):.1f} % in the last quarter; more --cars with --resume go on")
    for name, row in found.named.items():
        words = [*trials.fixed, *(f"{path}={value!r}" for path, value in problem.changes(tried.points[row]).items())]
        print(f"{name}: " + " ".join(f"--set {shlex.quote(word)}" for word in words))


def _share_error(quantile: float, cars: int) -> float:
    """Return the standard error of a share of cars, as large as that of the quantile or of 0.9 [-]."""
    share = min(quantile, 0.9)
    return math.sqrt(share * (1.0 - share) / cars)


main = command(parser, _job)
