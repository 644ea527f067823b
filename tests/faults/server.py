"""Process with the preloaded library that runs the cases of commands and prints their outcomes as lines of JSON."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import random
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.faults.cases import FAULTS, Bench
from tests.faults.commands import commands


def serve(work: Path, name: str, most: int, kills: int) -> None:
    """Run the cases of a command.

    Args:
        work: folder for inputs and results.
        name: name of the command.
        most: maximum number of cases of a fault, spread over all calls; 0 for all.
        kills: number of kills at random times.
    """
    with contextlib.redirect_stdout(sys.stderr):
        known = commands(work / "inputs")
        command = next(command for command in known if command.name == name)
        bench = Bench(command, work / name.replace(" ", "_"))
    chance = random.Random(name)
    for number in range(kills):
        print(json.dumps(dataclasses.asdict(bench.killed(number, chance))), flush=True)
    for fault_name, fault in FAULTS.items():
        count = sum(calls for kind, calls in bench.calls.items() if kind & fault.calls)
        print(json.dumps({"command": name, "fault": fault_name, "calls": count}), flush=True)
        for number in spread(count, most):
            print(json.dumps(dataclasses.asdict(bench.outcome(fault_name, number))), flush=True)


def spread(count: int, most: int) -> Sequence[int]:
    """Return the numbers 1 to `count`, or `most` of them with equal distances."""
    if not most or count <= most:
        return range(1, count + 1)
    return sorted({round((i + 0.5) * count / most + 0.5) for i in range(most)})


if __name__ == "__main__":
    for each in sys.argv[2].split(","):
        serve(Path(sys.argv[1]).resolve(), each, int(sys.argv[3]), int(sys.argv[4]))
