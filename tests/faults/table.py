"""Build the preloaded library, run the cases of commands in processes of their own, and count the outcomes."""

import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Count:
    """Outcomes of the cases of a command and a fault."""

    calls: int = 0  # number of system calls of the command that the fault can meet; 0 for kills at random times
    different: int = 0  # number of these calls without those between the first, the middle and the last of equal ones
    results: Counter[str] = field(default_factory=Counter)  # number of cases by their results, "old", "new" or "wrong"
    wrong: list[dict[str, Any]] = field(default_factory=list)  # cases in which something that must hold does not


def has_compiler() -> bool:
    """True if there is a C compiler on Linux, which the library needs."""
    return sys.platform.startswith("linux") and shutil.which("cc") is not None


def build(folder: Path) -> Path:
    """Compile the preloaded library."""
    library = folder / "faults.so"
    source = Path(__file__).with_name("faults.c")
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", str(library), str(source), "-ldl"], check=True)
    return library


def outcomes(
    library: Path, work: Path, names: str, most: int, kills: int, whole: Sequence[str] = (), limit: float = 0.0
) -> Iterator[Any]:
    """Yield the outcomes of commands; see `serve`.

    Args:
        library: of `build`.
        work: folder for inputs and results.
        names: names of the commands, with commas between them.
        most, kills, whole: see `serve`.
        limit: time after which the process is ended [s]; 0 for no limit.
    """
    settings = {"LD_PRELOAD": str(library), "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    log = work / f"{names.replace(' ', '_').replace(',', '_')}.log"
    command = ["timeout", str(limit), sys.executable, "-m", "tests.faults.server", str(work), names]
    command += [str(most), str(kills), *whole]
    environment = {**os.environ, **settings}
    with (
        log.open("w") as errors,
        subprocess.Popen(
            command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=errors, text=True
        ) as process,
    ):
        assert process.stdout
        yield from (json.loads(line) for line in process.stdout)
    if process.returncode not in (0, 124):
        raise RuntimeError(f"{names}: {log.read_text()[-2000:]}")


def counted(lines: Iterator[Any]) -> dict[tuple[str, str], Count]:
    """Count outcomes by command and fault."""
    table: dict[tuple[str, str], Count] = {}
    for line in lines:
        count = table.setdefault((line["command"], line["fault"]), Count())
        if "calls" in line:
            count.calls, count.different = line["calls"], line["different"]
        else:
            count.results[line["results"]] += 1
            if line["wrong"]:
                count.wrong.append(line)
    return table
