"""Fit of the section factors to what is known of the body: nine modes, the first at 19 Hz and the ninth at 43 Hz.

The torsion frequency is not published, only that a torsion mode couples with the vertical wheel mode at 28 Hz. So
frequency and amplitude of the torsion mode at the strut towers are chosen on the complete car with stuck dampers, such
that its wheel mode is at 28 Hz and gives the highest peak of the knuckle; the choice stands here as two constants.

Everything else is unpublished and only fills the gap, weighted low: modes spread over the range, a tenth mode above
it, modes of the whole body that are symmetric or antisymmetric, no node that moves far more than the body around it,
factors near one.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.optimize import least_squares

from vehicle.errors import ConfigurationError
from vehicle.flexbody.beam import FloatArray
from vehicle.flexbody.body_frame import BodyFrame
from vehicle.flexbody.mode_names import global_patterns, modal_assurance
from vehicle.flexbody.sections import SECTIONS
from vehicle.flexbody.symmetry import mirror_nodes, parity

FIRST_HZ, LAST_HZ = 19.0, 43.0
"""published: Bommer 2006, section 3.1.2"""
MODE_COUNT = 9
"""published"""
TORSION_HZ = 31.0
"""Fitted to the vertical wheel mode at 28 Hz of the complete car. With 28 Hz the highest peak of the knuckle is that of
the torsion mode at 31 Hz, from 28.5 Hz on that of the wheel mode at 28.4 Hz; with 31 Hz the wheel mode is the highest
peak for stuck and for slipping dampers, as published for all three levels."""
_TORSION_AMPLITUDE = 0.016  # kg^-1/2 vertical at a strut top, fitted as TORSION_HZ: less splits the wheel modes less
_SPREAD_HZ = (22.2, 25.2, 31.0, 33.2, 35.6, 38.0, 40.4)  # assumed for the modes between first and last
_GAP_HZ = 1.3  # assumed: closer modes of an almost symmetric body mix into lopsided ones
_TENTH_HZ = 46.8  # assumed: well above the last mode that is kept
_ASSURANCE = {"torsion": 0.55, "vertical bending": 0.40}  # assumed: of the torsion mode and of the first mode
_LIKE = 0.30  # assumed: likeness of every mode to some global pattern
_PARITY = 0.97  # assumed
_PAIR_ENERGY = 0.35  # assumed: largest share of kinetic energy of two facing nodes
_PAIR_DIFFERENCE = 0.10  # assumed: relative difference of the amplitudes of facing interface nodes
_BENDING_AMPLITUDE = 0.033  # kg^-1/2 vertical at a strut top in the first mode, assumed: as the body's mean 813^-1/2
_FACTOR = np.log(4.0)  # a factor of four away from nominal costs as much as one mode 5 Hz away from the spread
_BOUNDS = (np.log(0.06), np.log(16.0))
_MOUNTS = ("hydromount", "linear_mount", "bottom_")
_INTERFACES = ("arm_", "strut_top", "tie_", "stab_", "rear_support", "seat", *_MOUNTS)


def fitted_groups() -> tuple[str, ...]:
    """Member groups with a fitted factor."""
    return tuple(group for group, section in SECTIONS.items() if section.fitted)


def stored_factors() -> dict[str, float]:
    """The factors of `sections.py`, group -> factor [1]."""
    return {group: section.factor for group, section in SECTIONS.items()}


def residuals(frame: BodyFrame, factors: Mapping[str, float], weight: float) -> FloatArray:
    """What the fit minimises, as one vector [1]; the first three are first, last and torsion frequency.

    Args:
        frame: the body frame.
        factors: factor of every member group [1].
        weight: weight of first, last and torsion frequency [1/Hz]; everything else has weight of order one.
    """
    frequencies, shapes = frame.modes(factors, MODE_COUNT + 1)
    kept = shapes[:MODE_COUNT]
    likeness = {
        name: modal_assurance(kept, pattern, frame.node_mass)
        for name, pattern in global_patterns(frame.positions, frame.node_mass).items()
    }
    torsion = int(likeness["torsion"].argmax())
    missed = frequencies[[0, MODE_COUNT - 1, torsion]] - (FIRST_HZ, LAST_HZ, TORSION_HZ)
    tower = np.abs(kept[:, frame.nodes.index("strut_top_fr"), 2])
    return np.concatenate(
        [
            weight * missed,
            0.2 * (frequencies[1 : MODE_COUNT - 1] - _SPREAD_HZ),
            2.0 * np.maximum(0.0, _GAP_HZ - np.diff(frequencies[:MODE_COUNT])),
            [2.0 * max(0.0, _TENTH_HZ - frequencies[MODE_COUNT])],
            [8.0 * max(0.0, _ASSURANCE["torsion"] - likeness["torsion"][torsion])],
            [8.0 * max(0.0, _ASSURANCE["vertical bending"] - likeness["vertical bending"][0])],
            1.5 * np.maximum(0.0, _LIKE - np.max(list(likeness.values()), axis=0)),
            [250.0 * (tower[torsion] - _TORSION_AMPLITUDE)],
            [150.0 * max(0.0, tower[0] - _BENDING_AMPLITUDE)],
            4.0 * np.maximum(0.0, _PARITY - np.abs(parity(kept, frame.positions, frame.node_mass))),
            np.log([factors[group] for group in fitted_groups()]) / _FACTOR,
            _excess_motion(frame, kept),
        ]
    )


def _excess_motion(frame: BodyFrame, shapes: FloatArray) -> FloatArray:
    """Penalties [1] for nodes that move far more than the body around them, and for lopsided pairs."""
    amplitude = np.linalg.norm(shapes, axis=2)  # (modes, n)
    facing = mirror_nodes(frame.positions)
    interface = np.array([name.startswith(_INTERFACES) for name in frame.nodes])
    rails = np.array([name.startswith("seat_rail") for name in frame.nodes])
    right = np.flatnonzero((facing >= 0) & (frame.positions[:, 1] > 0.0))
    left = facing[right]
    energy = frame.node_mass * amplitude**2
    sides = amplitude[:, right], amplitude[:, left]
    difference = 2.0 * np.abs(sides[0] - sides[1]) / np.maximum(sides[0] + sides[1], 0.02)  # 0.01 counts as little
    return np.concatenate(
        [
            65.0 * np.maximum(0.0, amplitude[:, interface] - 0.045).ravel(),  # an effective mass of 490 kg
            100.0 * np.maximum(0.0, amplitude[:, rails] - 0.047).ravel(),  # where comfort is measured
            30.0 * np.maximum(0.0, amplitude[:, ~interface] - 0.060).ravel(),  # an effective mass of 280 kg
            10.0 * np.maximum(0.0, energy[:, right] + energy[:, left] - _PAIR_ENERGY).ravel(),
            2.0 * np.maximum(0.0, difference[:, interface[right]] - _PAIR_DIFFERENCE).ravel(),
        ]
    )


def fit_factors(frame: BodyFrame, start: Mapping[str, float], weights: tuple[float, ...]) -> dict[str, float]:
    """Factors that minimise `residuals`, in stages of growing weight of the three frequencies.

    Args:
        frame: the body frame.
        start: first guess of every factor [1].
        weights: weight of the three frequencies in each stage [1/Hz].

    Returns:
        Factor of every member group [1].

    Raises:
        ConfigurationError: the frequencies cannot be met within 0.1 Hz from this start.
    """
    groups = fitted_groups()

    def factors(logarithms: FloatArray) -> dict[str, float]:
        return {**start, **dict(zip(groups, np.exp(logarithms).tolist(), strict=True))}

    point = np.log([start[group] for group in groups])
    for weight in weights:
        stage = least_squares(
            lambda x, w=weight: residuals(frame, factors(x), w), point, bounds=_BOUNDS, max_nfev=40, diff_step=1e-6
        )
        point = stage.x
    best = factors(point)
    missed = np.abs(residuals(frame, best, 1.0)[:3])
    if missed.max() > 0.1:
        raise ConfigurationError(
            f"body fit: first, last and torsion frequency are {missed.round(3).tolist()} Hz away from {FIRST_HZ:g}, "
            f"{LAST_HZ:g} and {TORSION_HZ:g} Hz; 0.1 Hz is allowed. Start nearer or change the nominal sections."
        )
    return best
