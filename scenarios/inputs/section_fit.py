"""Section factors of a body design, fitted to published and assumed modal data of the trimmed body of Bommer 2006.

python -m scenarios.inputs.section_fit [--design FILE.toml] [--vehicle FILE.toml] [--set PATH=VALUE]

It prints the factors as lines of a design, from which `python -m vehicle body build` makes a body model.

Published for the body: nine modes, the first at 19 Hz and the ninth at 43 Hz, and that a torsion mode couples with the
vertical wheel mode at 28 Hz. The torsion mode lies below the wheel mode and pushes it up: frequency and amplitude at
the strut towers were chosen on the complete car with stuck dampers such that its wheel mode is at 28 Hz and gives the
highest peak of the knuckle. Torsion at 30.5 Hz leaves the wheel mode at 26.4 to 27.3 Hz.

Mode shapes are not published. A frame fitted to the frequencies alone has an antinode of its first five modes at the
seat rail (0.042 to 0.052 kg^-1/2 along z; the mean of the body is 813^-1/2 = 0.035), and seat-rail levels of 2.3 to 3
times those on the axes of figures 4.1 and 4.2. So the fit limits the amplitudes of the rail, and these levels count as
fitted. The comfort figures 4.3 to 4.12 and the bump figures 3.13 to 3.18 were consulted when limits and torsion mode
were chosen; the residuals contain none of these figures, but they do not count as predicted either. A free body that
bends as a parabola has an antinode at the seats in its middle: with small amplitudes of the rail, the first mode is a
pitching of the front on the soft door frame, with a modal assurance of 0.13 with bending.

The remaining residuals make the fit unique and have low weights: modes spread over the frequency range, a tenth mode
above the range, symmetric or antisymmetric modes, no node that moves far more than its surroundings, factors near one.
"""

import argparse
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.commands.command_line import parse_and_run
from vehicle.commands.options import message_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import BodyFrame, body_frame
from vehicle.model.flexbody.body_model import BODY_DESIGN
from vehicle.model.flexbody.mode_names import global_patterns, modal_assurance
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.symmetry import mirror_nodes, parity
from vehicle.runs.car import Car

FIRST_HZ, LAST_HZ = 19.0, 43.0
"""Frequencies of the first and last mode [Hz], published: Bommer 2006, section 3.1.2; first = lowest symmetric mode
(assumed)."""
MODE_COUNT = 9
"""Number of elastic modes, published: Bommer 2006, section 3.1.2."""
TORSION_HZ = 25.5
"""Frequency of the torsion mode [Hz], fitted to the vertical wheel mode at 28 Hz of the complete car."""
STAGES = (0.5, 2.0, 8.0, 30.0)
"""Weight of the three frequencies in the stages of a fit from the nominal sections [1/Hz]."""
_TORSION_AMPLITUDE = 0.018  # kg^-1/2 vertical at a strut top, fitted as TORSION_HZ
_TOWER = np.array([0.022] + 8 * [0.014])  # kg^-1/2, limit at the strut top per mode other than torsion
_RAIL = np.array([0.007, 0.011, 0.010] + 6 * [0.008])
"""Maximum amplitude of the seat rail along z [kg^-1/2] per mode: a fifth to a third of the mean of the body."""
_RAIL_SIDEWAYS = 0.012  # kg^-1/2, maximum amplitude of the seat rail along x and y
_SPREAD_HZ = (25.5, 30.5, 31.8, 33.2, 35.5, 38.0, 40.5)  # assumed for the modes between first and last
_GAP_HZ = 1.3  # assumed: closer modes of an almost symmetric body mix into asymmetric modes
_TENTH_HZ = 46.0  # assumed: well above the last mode of the superelement
_ASSURANCE = 0.38  # assumed: minimum modal assurance of the torsion mode with pure torsion
_PARITY = 0.97  # assumed: minimum |parity| of a mode
_NODE_ENERGY = 0.235  # assumed: maximum share of one node in the kinetic energy of a mode
_PAIR_DIFFERENCE = 0.10  # assumed: maximum relative difference of the amplitudes of opposite interface nodes
_FACTOR = np.log(4.0)  # maximum deviation from nominal is a factor of four; costs as much as a mode 3 Hz off
_MOUNTS = ("hydromount", "linear_mount", "bottom_")
_INTERFACES = ("arm_", "strut_top", "tie_", "stab_", "rear_support", "seat", *_MOUNTS)


def residuals(frame: BodyFrame, factors: Mapping[str, float], weight: float) -> Vector:
    """Return the residuals of the fit as a vector [1]: first, last and torsion frequency, then the other residuals.

    Args:
        frame: the body frame.
        factors: factor of every member group [1].
        weight: weight of first, last and torsion frequency [1/Hz]; the other residuals have weights of order one.
    """
    body = frame.skeleton
    frequencies, shapes = frame.modes(factors, MODE_COUNT + 1)
    kept = shapes[:MODE_COUNT]
    likeness = parity(shapes, body.positions, frame.node_mass)
    twist = modal_assurance(kept, global_patterns(body.positions, frame.node_mass)["torsion"], frame.node_mass)
    torsion = int(twist.argmax())
    first = int((likeness > 0.0).argmax())
    missed = frequencies[[first, MODE_COUNT - 1, torsion]] - (FIRST_HZ, LAST_HZ, TORSION_HZ)
    tower = np.abs(kept[:, body.node_index("strut_top_fr"), 2])
    return np.concatenate(
        [
            weight * missed,
            0.4 * (frequencies[1 : MODE_COUNT - 1] - _SPREAD_HZ),
            4.0 * np.maximum(0.0, _GAP_HZ - np.diff(frequencies[:MODE_COUNT])),
            [2.0 * max(0.0, _TENTH_HZ - frequencies[MODE_COUNT])],
            [16.0 * max(0.0, _ASSURANCE - twist[torsion])],
            [400.0 * (tower[torsion] - _TORSION_AMPLITUDE)],
            150.0 * np.maximum(0.0, np.delete(tower - _TOWER, torsion)),
            4.0 * np.maximum(0.0, _PARITY - np.abs(likeness[:MODE_COUNT])),
            0.6 / _FACTOR * np.log([factors[group] for group in frame.design.fitted_groups]),
            _excess_motion(body, frame.node_mass, kept),
        ]
    )


def _excess_motion(body: Superelement, node_mass: Vector, shapes: Vector) -> Vector:
    """Return penalties [1] for large motion of the seat rail or of single nodes, and for asymmetric pairs of nodes."""
    amplitude = np.linalg.norm(shapes, axis=2)  # (modes, n)
    facing = mirror_nodes(body.positions)
    interface = np.array([name.startswith(_INTERFACES) for name in body.nodes])
    rail, other = (np.abs(shapes[:, body.node_index(name)]) for name in ("seat_rail", "seat_rail_right"))  # (modes, 3)
    right = np.flatnonzero((facing >= 0) & (body.positions[:, 1] > 0.0))
    energy = node_mass * amplitude**2
    sides = amplitude[:, right], amplitude[:, facing[right]]
    difference = (
        2.0 * np.abs(sides[0] - sides[1]) / np.maximum(sides[0] + sides[1], 0.02)
    )  # amplitudes below 0.01 are small
    return np.concatenate(
        [
            500.0 * np.maximum(0.0, rail[:, 2] - _RAIL),
            250.0 * np.maximum(0.0, other[:, 2] - _RAIL),
            300.0 * np.maximum(0.0, rail[:, :2] - _RAIL_SIDEWAYS).ravel(),
            65.0 * np.maximum(0.0, amplitude[:, interface] - 0.045).ravel(),  # an effective mass of 490 kg
            30.0 * np.maximum(0.0, amplitude[:, ~interface] - 0.065).ravel(),  # an effective mass of 240 kg
            40.0 * np.maximum(0.0, energy.max(axis=1) - _NODE_ENERGY),
            2.0 * np.maximum(0.0, difference[:, interface[right]] - _PAIR_DIFFERENCE).ravel(),
        ]
    )


def fit_factors(frame: BodyFrame, start: Mapping[str, float], weights: tuple[float, ...]) -> dict[str, float]:
    """Fit the factors [1] of member groups that minimise `residuals`, in stages of growing weight of the frequencies.

    Args:
        frame: the body frame.
        start: initial value of every factor [1].
        weights: weight of the three frequencies in each stage [1/Hz].

    Raises:
        ConfigurationError: the fit from this start misses a frequency by more than 0.1 Hz.
    """
    groups = frame.design.fitted_groups

    def factors(logarithms: Vector) -> dict[str, float]:
        return {**start, **dict(zip(groups, np.exp(logarithms).tolist(), strict=True))}

    point = np.log([start[group] for group in groups])
    for weight in weights:
        stage = scipy.optimize.least_squares(
            lambda x, w=weight: residuals(frame, factors(x), w),
            point,
            bounds=(-_FACTOR, _FACTOR),
            max_nfev=40,
            diff_step=1e-6,
        )
        point = stage.x
    best = factors(point)
    missed = np.abs(residuals(frame, best, 1.0)[:3])
    if missed.max() > 0.1:
        raise ConfigurationError(
            f"body fit: first, last and torsion frequency differ by {missed.round(3).tolist()} Hz from "
            f"{FIRST_HZ:g}, {LAST_HZ:g} and {TORSION_HZ:g} Hz, must be at most 0.1 Hz. Change the nominal "
            "sections of the design, so that the fit starts nearer."
        )
    return best


def parser() -> Parser:
    """Return the parser of the options."""
    result = Parser(
        prog="python -m scenarios.inputs.section_fit",
        description="Fit the factors of the beam sections of a body design to the published body modes of Bommer 2006 "
        f"(first {FIRST_HZ:g} Hz, torsion {TORSION_HZ:g} Hz, ninth {LAST_HZ:g} Hz) and print them as lines of a "
        "design. Takes minutes.",
    )
    result.add_argument(
        "--design", type=Path, default=BODY_DESIGN, metavar="FILE.toml", help="file of the body design; default: focus"
    )
    vehicle_options(result)
    message_options(result)
    return result


def _job(options: argparse.Namespace) -> None:
    design = read_design(options.design)
    vehicle = Car.load(options.vehicle, options.overrides).vehicle
    frame = body_frame(design, vehicle.points, NodeProperties.of_body(vehicle.body, design.least_ixx))
    factors = fit_factors(frame, dict.fromkeys(design.factors, 1.0), STAGES)
    for group in design.fitted_groups:
        print(f"members.{group}.factor = {factors[group]:.5g}")


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
