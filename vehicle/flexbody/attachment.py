"""Local stiffness of the points where springs, mounts and joints are fixed to the trimmed body.

Nine global modes are too few to hold the dent that a force makes beside the bolt. The thesis measured that local
stiffness and added it (Craig-Bampton residual); it did not publish the numbers, so these are assumed, and
fitted where the complete car says something about them.
"""

from __future__ import annotations

import numpy as np

from vehicle.flexbody.beam import FloatArray

# node pair or node: (x, y, z) [N/m], vehicle frame; assumed, typical of passenger-car bodies, where no fit is named
_PAIRS: dict[str, tuple[float, float, float]] = {
    "strut_top": (1.5e7, 1.5e7, 0.8e7),  # tower top; z fitted to the vertical wheel mode at 28 Hz of the complete car
    "arm_front": (2.0e7, 1.5e7, 1.0e7),  # subframe, along its legs stiffest
    "arm_rear": (1.5e7, 1.5e7, 1.0e7),  # subframe
    "tie_inner": (1.0e7, 1.0e7, 1.0e7),  # steering rack bracket
    "stab_body": (1.0e7, 1.0e7, 1.0e7),  # bar clamp on the subframe
}
_SIDES = {"rear_support": (1.0e7, 1.0e7, 1.0e7)}  # rear rail under the rubber block
_CENTRE = {
    # brackets on the right and the left rail: fitted to the engine modes of 10 to 20 Hz (the highest is 0.8 Hz too high
    # with brackets of 1e7 N/m); stiffest along z, where the engine's weight is carried
    "hydromount": (0.3e7, 0.3e7, 0.5e7),
    "linear_mount": (0.3e7, 0.3e7, 0.5e7),
    "bottom_body": (1.0e7, 0.6e7, 0.6e7),  # torque arm: pulls along x
}


def attachment_stiffness() -> dict[str, FloatArray]:
    """Node -> local stiffness along x, y, z [N/m], shape (3,)."""
    table = {f"{pair}_{wheel}": k for pair, k in _PAIRS.items() for wheel in ("fr", "fl")}
    table |= {f"{pair}_{side}": k for pair, k in _SIDES.items() for side in ("right", "left")}
    return {node: np.array(k) for node, k in (table | _CENTRE).items()}
