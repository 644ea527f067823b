"""Read the summary of a run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


def run_summary(folder: Path) -> dict[str, Any]:
    """Return the content of `summary.json` in the folder of a run; empty if missing or unreadable."""
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return summary if isinstance(summary, dict) else {}
