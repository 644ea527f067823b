"""Process with the preloaded library that runs the cases of commands and prints their outcomes as lines of JSON."""

import contextlib
import dataclasses
import json
import random
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.faults.cases import FAULTS, Bench
from tests.faults.commands import keep_cars
from tests.faults.jobs import commands


def serve(work: Path, name: str, most: int, kills: int, whole: Sequence[str]) -> None:
    """Run the cases of a command.

    Args:
        work: folder for inputs and results.
        name: name of the command.
        most: maximum number of cases of a fault, spread over all different calls; 0 for all.
        kills: number of kills at random times.
        whole: names of the faults that are tried at all different calls.
    """
    with contextlib.redirect_stdout(sys.stderr):
        known = commands(work / "inputs")
        command = next(command for command in known if command.name == name)
        bench = Bench(command, work / name.replace(" ", "_"))
    chance = random.Random(name)
    for number in range(kills):
        print(json.dumps(dataclasses.asdict(bench.killed(number, chance))), flush=True)
    for fault_name, fault in FAULTS.items():
        calls, numbers = bench.numbers(fault)
        print(json.dumps({"command": name, "fault": fault_name, "calls": calls, "different": len(numbers)}), flush=True)
        for number in spread(numbers, most if fault_name not in whole else 0):
            print(json.dumps(dataclasses.asdict(bench.outcome(fault_name, number))), flush=True)


def spread(numbers: Sequence[int], most: int) -> Sequence[int]:
    """Return all numbers, or `most` of them with equal distances."""
    if not most or len(numbers) <= most:
        return numbers
    return [numbers[int((i + 0.5) * len(numbers) / most)] for i in range(most)]


if __name__ == "__main__":
    keep_cars()
    for each in sys.argv[2].split(","):
        serve(Path(sys.argv[1]).resolve(), each, int(sys.argv[3]), int(sys.argv[4]), sys.argv[5:])
