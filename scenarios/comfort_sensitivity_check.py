"""The reduced engine against MuJoCo at the corner points of the comfort study."""

from __future__ import annotations

from scenarios.comfort_observation import Question
from scenarios.comfort_sensitivity_runs import (
    DEGRESSIVE,
    FRICTION,
    MOUNT_DAMPING,
    MOUNT_STIFFNESS,
    Changes,
    ComfortRuns,
)
from scenarios.road_signals import ROAD_RMS
from vehicle.reduced.march import has_compiler

ENGINES = ("reduced", "mujoco")


def corners(comfort: ComfortRuns) -> dict[str, Changes]:
    """Cars of the check by name; the nominal one first."""
    found: dict[str, Changes] = {"nominal": ()}
    for variation in (FRICTION, MOUNT_DAMPING, MOUNT_STIFFNESS):
        cars = comfort.cars(variation)
        for value in (variation.values[0], variation.values[-1]):
            if cars[value]:
                found[f"{variation.label}: {value:g}"] = cars[value]
    return {**found, "degressive damper": DEGRESSIVE}


def check_questions(comfort: ComfortRuns) -> list[Question]:
    """Runs of the check: the first record with both engines; none without numba, which the reduced one needs."""
    if not has_compiler():
        return []
    return [
        question
        for car in corners(comfort).values()
        for road in ROAD_RMS
        for engine in ENGINES
        for question in comfort.questions(car, road, engine=engine, count=1)
    ]


def check_table(comfort: ComfortRuns) -> str:
    """Differences of both engines as a Markdown table."""
    if not has_compiler():
        return "The reduced engine was not compared with MuJoCo: it needs numba."
    lines = [
        f"Reduced engine against MuJoCo, one record of {comfort.records.duration:g} s (on the rough road parts turn by "
        "more than the 0.05 rad that the reduced engine vouches for):",
        "",
        "| car | road | comfort value, MuJoCo [m/s²] | reduced against it [%] | relative comfort value, MuJoCo, "
        "reduced [%] | slip share, MuJoCo, reduced [%] | lowest load, MuJoCo, reduced [N] |",
        "|---|---|---|---|---|---|---|",
    ]
    for road in ROAD_RMS:
        reference: dict[str, float] = {}
        for name, car in corners(comfort).items():
            reduced, mujoco = (comfort(comfort.questions(car, road, engine=engine, count=1))[0] for engine in ENGINES)
            reference = reference or {"reduced": reduced.comfort, "mujoco": mujoco.comfort}
            lines.append(
                f"| {name} | {road} | {mujoco.comfort:.4f} | {100.0 * (reduced.comfort / mujoco.comfort - 1.0):+.2f} | "
                f"{100.0 * mujoco.comfort / reference['mujoco']:.2f}, "
                f"{100.0 * reduced.comfort / reference['reduced']:.2f} | {100.0 * mujoco.slip:.2f}, "
                f"{100.0 * reduced.slip:.2f} | {mujoco.lowest_load:.0f}, {reduced.lowest_load:.0f} |"
            )
    return "\n".join(lines)
