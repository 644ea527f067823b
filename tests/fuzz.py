"""Mutated inputs against the commands: no traceback, no hang, no exit code outside the contract, no NaN with code 0.

`python -m tests.fuzz --count 2000` runs the mutations 0 to 1999; `--first N --count 1` runs one again, `--kind file`
those of damaged measurement files alone. Each mutation depends on its number alone. Everything happens in this
process, with a signal of two seconds and the reduced engine.
"""

import argparse
import contextlib
import io
import json
import math
import os
import random
import re
import signal as signals
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scenarios.signals.random_road import random_road
from tests.fuzz_commands import COMMAND_KINDS
from tests.fuzz_files import file_case, judge_file, largest_memory
from tests.fuzz_texts import WORDS, mutated
from tests.patience import HANG
from vehicle.commands import comfort, modes, shaker, sweep
from vehicle.commands.command_line import FAULT
from vehicle.model.parameters.shipped import FOCUS_FILE

CODES = {0, 2, 3, 4, 5, 6}
"""Exit codes of the contract; 130 needs an interruption."""

ROWS = [
    f"{k / 500:.3f},{z:.6e}"
    for k, z in enumerate(random_road(rms=2e-4, seed=1, wheel="fr", duration=2.0).displacement["fr"][::2])
]
SIGNAL = "\n".join(["time [s],displacement [m]", *ROWS]) + "\n"
CAR = FOCUS_FILE.read_text(encoding="utf-8")
PATHS = sorted(
    {
        f"{table}.{name}"
        for part in re.split(r"^\[", CAR, flags=re.M)[1:]
        for table in [part.partition("]")[0]]
        for name in re.findall(r"^(\w+) =", part, flags=re.M)
    }
)


@dataclass(frozen=True)
class Outcome:
    """What a case led to, and what is wrong with it; nothing, if `wrong` is empty."""

    kind: str
    code: int
    wrong: str
    said: str


def write(name: str, text: str, rng: random.Random) -> str:
    """Write a file, with now and then a byte that is no text."""
    raw = text.encode("utf-8", errors="replace")
    if rng.random() < 0.1 and raw:
        at = rng.randrange(len(raw))
        raw = raw[:at] + bytes([rng.randrange(256)]) + raw[at + 1 :]
    Path(name).write_bytes(raw)
    return name


def setting(rng: random.Random) -> str:
    """A PATH=VALUE, sometimes with a damaged path."""
    path = rng.choice(PATHS) + rng.choice(["", "", "", ".z", ".q"])
    value = rng.choice([rng.choice(WORDS), f"{10.0 ** rng.uniform(-9.0, 9.0):.4g}", f"{rng.uniform(0.2, 5.0):.4g}"])
    text = f"{path}={value}"
    return mutated(text, rng) if rng.random() < 0.3 else text


def record(rng: random.Random) -> str:
    """A record of acceleration in three axes."""
    rate = rng.choice([400, 1000, 50])
    values = np.random.default_rng(rng.randrange(10**6)).normal(0.0, 0.5, (rng.choice([3, 900, 2000]), 3))
    lines = [f"{k / rate:.6f}," + ",".join(f"{value:.5g}" for value in row) for k, row in enumerate(values)]
    return "\n".join(["time [s],x [m/s2],y [m/s2],z [m/s2]", *lines]) + "\n"


Case = Callable[[random.Random], tuple[Callable[[list[str]], int], list[str]]]


def _signal(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    options = rng.choice([[], ["--any-level"], ["--interpolate"], ["--resample", "500"], ["--remove-mean"]])
    file = write("signal.csv", mutated(SIGNAL, rng), rng)
    return shaker.main, ["--input", file, "--engine", "reduced", "--output", "out", *options]


def _vehicle(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    file = write("car.toml", mutated(CAR, rng), rng)
    if rng.random() < 0.3:
        return modes.main, ["--vehicle", file, "--json"]
    return shaker.main, ["--input", "good.csv", "--vehicle", file, "--engine", "reduced", "--output", "out"]


def _setting(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    options = [word for _ in range(rng.randint(1, 2)) for word in ("--set", setting(rng))]
    return shaker.main, ["--input", "good.csv", "--engine", "reduced", "--output", "out", *options]


def _table(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    text = f"damper.viscous,{rng.choice(PATHS)}\n2000,{rng.uniform(0.1, 10.0):.3g}\n1500,{rng.choice(WORDS)}\n"
    options = ["--table", write("table.csv", mutated(text, rng), rng)]
    if rng.random() < 0.3:
        options = ["--vary", setting(rng) + "," + rng.choice(WORDS)]
    options += ["--executor", "tests.fuzz:here", "--skip", rng.choice(["0.5", "0", "-1", "nan", "1e9"])]
    return sweep.main, ["--input", "good.csv", "--engine", "reduced", "--output", "out", *options]


def _record(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    options = rng.choice(
        [[], ["--offset", "remove"], ["--offset", "keep"], ["--place", "feet"], ["--place", "nowhere"]]
    )
    return comfort.main, ["--input", write("record.csv", mutated(record(rng), rng), rng), "--json", *options]


KINDS: dict[str, Case] = {
    "csv": _signal, "toml": _vehicle, "set": _setting, "table": _table, "record": _record, "file": file_case,
    **COMMAND_KINDS,
}  # fmt: skip


def here():
    """An executor that works in this process."""
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(1)


@contextlib.contextmanager
def deadline(seconds: int) -> Iterator[None]:
    """Raise TimeoutError after a time."""

    def late(*_: object) -> None:
        raise TimeoutError(f"no end after {seconds} s")

    before = signals.signal(signals.SIGALRM, late)
    signals.alarm(seconds)
    try:
        yield
    finally:
        signals.alarm(0)
        signals.signal(signals.SIGALRM, before)


def run_case(index: int, only: str = "") -> Outcome:
    """Run one mutation in an empty folder, of all kinds in turn or of one."""
    rng = random.Random(index)
    kind = only or list(KINDS)[index % len(KINDS)]
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        out, err, code, wrong = io.StringIO(), io.StringIO(), -1, ""
        try:
            Path("good.csv").write_text(SIGNAL, encoding="utf-8")
            command, arguments = KINDS[kind](rng)
            memory = largest_memory()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), deadline(HANG):
                code = command(arguments)
            said = (code, out.getvalue(), err.getvalue())
            wrong = judge_file(*said, memory) if kind == "file" else judge(*said)
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            wrong = f"{type(error).__name__}: {error}"
        finally:
            os.chdir(before)
    return Outcome(kind, code, wrong, err.getvalue().strip()[:300])


def judge(code: int, out: str, err: str) -> str:
    """What is wrong with the end of a command; empty where nothing is."""
    if code not in CODES:
        return f"exit code {code}"
    if "Traceback" in err or FAULT in err:
        return "traceback, or an error that nobody has foreseen"
    if code and not err.startswith("error: "):
        return "no message"
    if code == 0:
        texts = [out, *(path.read_text(encoding="utf-8") for path in Path().glob("out/*.json"))]
        for text in texts:
            # First slips that never come are NaN by contract in tables, null in JSON.
            if re.search(r"(?<![\w.])-?(nan|inf|infinity)(?![\w.])", text, re.IGNORECASE):
                return f"a number that is none: {text[:200]}"
        if Path("out/time.npz").exists():
            with np.load("out/time.npz", allow_pickle=False) as record:
                bad = [
                    name
                    for name in record.files
                    if record[name].dtype.kind == "f" and not np.isfinite(record[name]).all()
                ]
            if bad:
                return f"not finite: {bad[:3]}"
        summary = Path("out/summary.json")
        if summary.exists():
            # A mutated vehicle file may have no seat rail, or another name for it; `drive` has no comfort.
            for point, comfort in json.loads(summary.read_text()).get("comfort", {}).items():
                value = comfort["rms_2_50_hz"]["overall"]
                if not (isinstance(value, float) and math.isfinite(value)):
                    return f"comfort at {point} {value!r}"
    return ""


def main(arguments: list[str] | None = None) -> int:
    """Run many cases and print what went wrong; returns 1 if anything did."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kind", choices=list(KINDS), default="", help="mutations of this kind alone")
    options = parser.parse_args(arguments)
    codes: Counter[tuple[str, int]] = Counter()
    failed = 0
    for index in range(options.first, options.first + options.count):
        outcome = run_case(index, options.kind)
        codes[outcome.kind, outcome.code] += 1
        if outcome.wrong or options.count == 1:
            failed += bool(outcome.wrong)
            print(f"{index} {outcome.kind} {outcome.code}: {outcome.wrong} | {outcome.said}", flush=True)
    print(
        f"{options.count} mutations, {failed} wrong; "
        + ", ".join(f"{k} {c}: {n}" for (k, c), n in sorted(codes.items()))
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
