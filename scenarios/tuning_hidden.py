"""The car that the made data come from. Only the data and the comparison read it; the fit does not."""

from __future__ import annotations

HIDDEN = {
    "bushings.suspension_mount.stiffness.x": 2.85e6,
    "bushings.suspension_mount.stiffness.y": 3.2e6,
    "bushings.suspension_mount.stiffness.z": 6.8e5,
    "stabilizer.torsional_stiffness": 4.7e3,
    "main_spring.stiffness": 2.62e4,
    "bushings.linear_mount.stiffness.z": 5.2e5,
    "bushings.torque_arm_engine.stiffness.x": 4.8e5,
    "damper.viscous": 2150.0,
    "damper.coulomb_friction": 118.0,
    "bushings.torque_arm_body.stiffness.z": 1.1e5,
}
"""The final set of appendix F, each value a few percent beside it."""
