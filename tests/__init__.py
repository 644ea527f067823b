"""Tests of the package, and what measures and checks it."""

import os
import shutil
import sys
import tempfile
from pathlib import Path

# Where Python keeps no bytecode, as in many containers, each process of a test would compile all modules, for 3 s.
if os.environ.pop("PYTHONDONTWRITEBYTECODE", ""):
    bytecode = Path(__file__).resolve().parents[1] / ".pytest_cache" / "bytecode"
    sys.dont_write_bytecode = False
    sys.pycache_prefix = os.environ["PYTHONPYCACHEPREFIX"] = str(bytecode)
    # Copies of the package in temporary folders are never imported again.
    shutil.rmtree(bytecode.joinpath(*Path(tempfile.gettempdir()).parts[1:]), ignore_errors=True)
