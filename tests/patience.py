"""Processes of the tests, and the time after which one of them is taken to hang; no test judges speed by it."""

import os
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]

HANG = 900
"""Maximum time of anything that a test waits for [s]: many times that of a busy machine with slow cores."""


def process(*words: str, cwd: Path, text: bool = True, **environment: str) -> subprocess.CompletedProcess[Any]:
    """Run a process with this package in a folder, with further variables of the environment."""
    variables = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    return subprocess.run(words, cwd=cwd, env=variables, capture_output=True, text=text, timeout=HANG)
