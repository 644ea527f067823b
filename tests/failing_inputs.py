"""Inputs of others that once gave wrong numbers: a folder beside the project, of which the project holds no copy."""

from pathlib import Path

import pytest

FAILING = Path(__file__).resolve().parents[2] / "shared" / "data" / "failing-inputs"

beside_the_project = pytest.mark.skipif(not FAILING.is_dir(), reason="the folder of inputs is not beside the project")
"""Mark of a test that reads them."""
