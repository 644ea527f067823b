"""Hardpoints for the tests of the shapes: a front end similar to the shipped car, without reading its file."""

import numpy as np
import pytest

SIDE = {
    "wheel_center": (0.85, 0.747, 0.695), "tyre_patch": (0.85, 0.747, 0.4), "lower_ball": (0.845, 0.7, 0.595),
    "arm_front": (0.842, 0.365, 0.605), "arm_rear": (1.135, 0.385, 0.6), "strut_top": (0.877, 0.548, 1.23),
    "damper_bottom": (0.852, 0.64, 0.72), "spring_lower": (0.8625, 0.6015, 0.935), "tie_outer": (0.985, 0.69, 0.648),
    "tie_inner": (0.985, 0.335, 0.66), "stab_body": (1.1, 0.33, 0.655), "stab_end": (0.875, 0.585, 0.665),
    "stab_rod_top": (0.868, 0.598, 0.93),
}  # fmt: skip
CENTRE = {
    "engine_cog": (0.72, 0.0, 0.9), "hydromount": (0.8, 0.44, 1.1), "linear_mount": (0.8, -0.42, 1.02),
    "bottom_engine": (0.98, 0.0, 0.62), "bottom_body": (1.13, 0.0, 0.62), "seat_rail": (2.05, -0.37, 0.7),
    "seat": (2.15, -0.37, 0.85), "roof_left_rear": (3.9, -0.5, 1.85), "body_front": (0.45, 0.0, 0.95),
    "rear_support_right": (3.465, 0.5, 0.72), "rear_support_left": (3.465, -0.5, 0.72),
}  # fmt: skip


@pytest.fixture(scope="session")
def points() -> dict[str, np.ndarray]:
    """Return the hardpoints of both sides [m], by name."""
    result = {name: np.array(value) for name, value in CENTRE.items()}
    for name, value in SIDE.items():
        result[f"{name}_fr"] = np.array(value)
        result[f"{name}_fl"] = np.array(value) * (1, -1, 1)
    return result
