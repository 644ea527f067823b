"""Decoupling of a part on its mounts as a table and as JSON."""

import json

import numpy as np

from vehicle.engines.linear.decoupling import MOTIONS, Decoupling


def decoupling_table(modes: Decoupling, aim: float | None = None) -> str:
    """Return the shares of the motions in each mode, and the torque roll axis.

    Args:
        aim: percentage; modes whose largest share is below are marked.
    """
    state = "body fixed" if modes.grounded else "in the car"
    lines = [
        f"{modes.part} on its mounts, {state}; shares of its kinetic energy [%]",
        f"{'Hz':>8} {'damping':>8} {'energy':>7}" + "".join(f"{name:>9}" for name in MOTIONS),
    ]
    for mode in modes.modes:
        shares = 100.0 * mode.shares
        largest = int(np.argmax(shares))
        mark = f"  below {aim:g}" if aim is not None and shares[largest] < aim else ""
        lines.append(
            f"{mode.frequency:8.3f} {100.0 * mode.damping_ratio:6.2f} % {100.0 * mode.energy:5.0f} %"
            + "".join(f"{share:9.1f}" for share in shares)
            + f"  {MOTIONS[largest]}{mark}"
        )
    x, y, z = (value + 0.0 for value in modes.roll_axis.round(3))
    lines.append(
        f"torque roll axis ({x:g}, {y:g}, {z:g}), {modes.angle:.1f} degrees from the crankshaft; rotation about "
        f"it has {modes.roll_frequency:.2f} Hz with the body fixed; residual {modes.residual:.3f} (0: it is "
        "exactly a mode)"
    )
    return "\n".join(lines)


def decoupling_json(modes: Decoupling) -> str:
    """Return frequencies, tables of the kinetic energy and the torque roll axis as JSON."""
    return json.dumps(
        {
            "part": modes.part,
            "grounded": modes.grounded,
            "motions": list(MOTIONS),
            "modes": [
                {
                    "frequency_hz": mode.frequency,
                    "damping_ratio": mode.damping_ratio,
                    "energy": mode.energy,
                    "shares": mode.shares.tolist(),
                    "table": mode.table.tolist(),
                }
                for mode in modes.modes
            ],
            "torque_roll_axis": modes.roll_axis.tolist(),
            "angle_deg": modes.angle,
            "roll_frequency_hz": modes.roll_frequency,
            "residual": modes.residual,
        },
        indent=2,
    )
