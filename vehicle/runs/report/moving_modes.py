"""Modes of a car as numbers for the script of the page: points, lines, and complex displacements."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.wireframe import GROUPS, CarWireframe, unit_factor
from vehicle.engines.linear.car_modes import Mode

FULL = 999
"""Maximum displacement of a mode in the data of the page: a step of 1/999 is finer than a pixel."""

SHADES = 24
"""Number of colours from rest to the maximum displacement."""


def mode_set(name: str, wheel: str, wire: CarWireframe, modes: Mapping[str, Sequence[Mode]]) -> dict[str, Any]:
    """Return the modes of one car for the script of the page.

    Args:
        modes: modes for dampers "stuck" and "sliding".

    Returns:
        Content for JSON; coordinates in millimetres.
    """
    return {
        "name": name,
        "wheel": f"wheel {wheel}",
        "points": np.rint(1e3 * wire.points).astype(int).ravel().tolist(),
        "lines": wire.lines.ravel().tolist(),
        "groups": wire.groups.tolist(),
        "states": {state: [_mode(wire, mode) for mode in state_modes] for state, state_modes in modes.items()},
    }


def _mode(wire: CarWireframe, mode: Mode) -> dict[str, Any]:
    """Return a mode, scaled and rotated in phase so that its maximum displacement is real and equal to `FULL`."""
    moved = wire.displacement(mode.shape)
    moved = unit_factor(moved) * moved
    return {
        "hz": round(mode.frequency, 4),
        "zeta": round(mode.damping_ratio, 5),
        "text": mode.description,
        "energy": [[name, round(100 * share)] for name, share in _largest(mode.energy)],
        "re": np.rint(FULL * moved.real).astype(int).ravel().tolist(),
        "im": np.rint(FULL * moved.imag).astype(int).ravel().tolist(),
    }


def _largest(energy: Mapping[str, float]) -> list[tuple[str, float]]:
    shares = sorted(energy.items(), key=lambda item: -item[1])
    return [(name.replace("_", " "), share) for name, share in shares if share >= 0.03]


def as_json(sets: Sequence[Mapping[str, Any]]) -> str:
    """Return the mode sets as JSON text that is safe inside a script element."""
    table = colours(np.linspace(0.0, 1.0, SHADES), 1.0)[:, :3]
    shades = ["#" + "".join(f"{round(255 * float(part)):02x}" for part in colour) for colour in table]
    text = json.dumps({"full": FULL, "groups": GROUPS, "shades": shades, "cars": list(sets)}, separators=(",", ":"))
    return text.replace("<", "\\u003c")
