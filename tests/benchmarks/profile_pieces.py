"""Part `profile` of `python -m tests.benchmarks.coverage`: values of whole made profiles from pieces of them."""

import itertools
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from vehicle.runs.car import Car, Road
from vehicle.runs.car.profile_value import over_profile
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad

STEP, TRACK = 0.05, 1.5
"""Distance of the points and of the tracks [m]."""


def made_profile(file: Path, kind: str, seed: int, length: float) -> Path:
    """Write a made profile.

    Args:
        file: its file.
        kind: "rising" from class B to C, with changes of the level every 100 m by exp(N(0, 0.5^2)); or "bumps", class B
            with a bump or hole of 10 to 30 mm every 670 m, on one or both tracks.
        seed: of the phases and the changes.
        length: its length [m].
    """
    count, rng = round(length / STEP) + 1, np.random.default_rng(seed)
    road, x = IsoRoad(level=CLASSES["B"], seed=seed, track=TRACK, quadruples=False), STEP * np.arange(count)
    tracks = {side: road.height(0.0, STEP, count, side, 0.4 / STEP) for side in ("left", "right")}
    if kind == "rising":
        places = np.arange(0.0, length + 200.0, 100.0)
        change = np.exp(0.5 * np.interp(x, places, rng.standard_normal(places.size)))
        level = np.interp(x / length, [0.0, 0.3, 0.6, 1.0], [1.0, 1.0, 4.0, 4.0]) * change
        tracks = {side: np.sqrt(level) * height for side, height in tracks.items()}
    else:
        for _ in range(round(length / 670.0)):
            place, width = rng.uniform(100.0, length - 100.0), rng.uniform(0.3, 1.2)
            height = rng.uniform(0.01, 0.03) * rng.choice([-1.0, 1.0])
            for side in (("left",), ("right",), ("left", "right"))[rng.integers(3)]:
                tracks[side] += height * np.sin(np.pi * np.clip((x - place) / width, 0.0, 1.0)) ** 2
    columns, heads = np.column_stack([x, tracks["left"], tracks["right"]]), "distance [m],left [m],right [m]"
    np.savetxt(file, columns, delimiter=",", header=heads, comments="", fmt="%.7g")
    return file


def of_whole(car: Car, file: Path) -> dict[str, float]:
    """Return the values of a run over a whole profile at 80 km/h."""
    run = car.run(Road(file, 80.0), "reduced", stated_errors=False)
    loads = {
        f"tyre_load_{wheel}": float(np.sqrt(np.mean((run[f"tyre_{wheel}_force_z"] - load)[run.evaluated] ** 2)))
        for wheel, load in run.car.static.tyre_load.items()
    }
    return {**run.comfort().values, **loads}


def profile(repetitions: int) -> list[dict[str, Any]]:
    """Values over 2 km at 80 km/h from pieces, for a precision of 1 %, against runs over the whole."""
    rows: list[dict[str, Any]] = []
    with TemporaryDirectory() as folder:
        for name, kind in itertools.product(("sedan", "focus_road"), ("rising", "bumps")):
            car, found = Car.load(name), dict[str, list[tuple[float, float]]]()
            lengths = []
            for seed in range(1, repetitions + 1):
                file = made_profile(Path(folder) / f"{kind}_{seed}.csv", kind, seed, 2000.0)
                value, whole = over_profile(car, Road(file, 80.0, precision=1.0)), of_whole(car, file)
                lengths.append(value.run.signal.duration)
                for each in ("weighted", "weighted_x", "unweighted", "tyre_load_fr", "tyre_load_rl"):
                    half = value.half_intervals[each] / whole[each]
                    found.setdefault(each, []).append((value.values[each] / whole[each] - 1.0, half))
            for each, pairs in found.items():
                error, half = np.array(pairs).T
                rows.append(
                    {
                        "car": f"{name}, {kind}",
                        "value": each,
                        "run_s": np.mean(lengths),
                        "bias_percent": 100.0 * np.mean(error),
                        "error_percent": 100.0 * np.sqrt(np.mean(error**2)),
                        "half_width_percent": 100.0 * np.sqrt(np.mean(half**2)),
                        "covers_95": np.mean(np.abs(error) < half),
                    }
                )
    return rows
