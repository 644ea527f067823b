"""Tests of the package, and what measures and checks it."""

import os
import sys
from pathlib import Path

# Where Python keeps no bytecode, as in many containers, each process of a test would compile all modules, for 3 s.
if os.environ.pop("PYTHONDONTWRITEBYTECODE", ""):
    sys.dont_write_bytecode = False
    sys.pycache_prefix = str(Path(__file__).resolve().parents[1] / ".pytest_cache" / "bytecode")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
