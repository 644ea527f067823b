"""Write a stone pavement as an OpenCRG surface: `python -m scenarios.inputs.make_block [--output FILE.crg]`.

Its spectrum along the tracks is that of the surface `belgian_block.crg` of ASAM OpenCRG, whose 10 m are too short for a
drive and whose terms of use do not clearly allow a copy. With random phases, and waves that run obliquely,

    z(u, v) = sum over j of a_j cos(2 pi (n_j u + m_j v) + phi_j),   n_j = j / L,

the lines of a band share its mean square equally; m_j is uniform between -n_j and n_j, so that the two tracks of a
car are unrelated above one wave in their distance.
"""

import argparse
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.runs.output.folder import write_text

EDGES = (0.15, 0.35, 0.45, 0.55, 0.75, 1.05, 1.65, 3.25, 6.45, 12.85, 25.65)
"""Limits of bands of the wavenumber [cycles/m]."""

RMS = (5.71, 13.09, 15.63, 0.09, 3.97, 6.52, 3.28, 3.92, 2.07, 1.14)
"""RMS of the bands [mm] for which `PUBLISHED` is found by the same estimate."""

PUBLISHED = (7.82, 12.43, 13.43, 6.22, 3.88, 6.37, 3.47, 3.92, 2.09, 1.15)
"""Estimated RMS of the bands [mm] of belgian_block.crg: mean square over 31 tracks without their line, by a Hann window
over its 10 m, which spreads the waves of 2 to 2.5 m over the neighbouring bands."""

STEP, SECTIONS = 0.01, 5
"""Distance of the rows [m], and number of long sections over the width."""

HALF_WIDTH = 1.2
"""Half width of the surface [m]: wider than the track of a car."""

BASE = 2.0
"""Height of the reference line [m]; in a text file of seven digits, heights are then exact to 0.5 um."""

HEADER = """$CT
stone pavement, spectrum of belgian_block.crg of ASAM OpenCRG, random phases; made by scenarios.inputs.make_block
$ROAD_CRG
REFERENCE_LINE_START_U = 0.0
REFERENCE_LINE_END_U = {end:.4f}
REFERENCE_LINE_INCREMENT = {step}
LONG_SECTION_V_RIGHT = {right}
LONG_SECTION_V_LEFT = {left}
LONG_SECTION_V_INCREMENT = {across}
$KD_Definition
#:LRFI
U:reference line u,m,0,{step}
{sections}
$
$$$$$$$$
"""


def block_heights(length: float, seed: int) -> Vector:
    """Return heights over the base [m], (rows, SECTIONS), from right to left.

    Args:
        length: length L [m], after which the surface repeats.
        seed: seed of the PCG64 generator of phases and directions.
    """
    rows = round(length / STEP) + 1
    v = np.linspace(-HALF_WIDTH, HALF_WIDTH, SECTIONS)
    spectrum = np.zeros((rows - 1, SECTIONS), dtype=np.complex128)
    generator = np.random.Generator(np.random.PCG64(seed))
    for low, high, rms in zip(EDGES, EDGES[1:], RMS, strict=False):
        lines = np.arange(round(low * length), round(high * length))
        across = lines / length * generator.uniform(-1.0, 1.0, lines.size)
        phases = 2.0 * np.pi * (generator.random(lines.size)[:, None] + across[:, None] * v)
        spectrum[lines] += 1e-3 * rms * np.sqrt(2.0 / lines.size) * np.exp(1j * phases)
    surface = np.fft.ifft(spectrum, axis=0).real * (rows - 1)
    return np.vstack([surface, surface[:1]])


def write_block(path: Path, length: float, seed: int) -> None:
    """Write the surface as an OpenCRG file; see `block_heights`."""
    surface = BASE + block_heights(length, seed)
    head = HEADER.format(
        end=STEP * (len(surface) - 1),
        step=STEP,
        right=-HALF_WIDTH,
        left=HALF_WIDTH,
        across=2.0 * HALF_WIDTH / (SECTIONS - 1),
        sections="\n".join(f"D:long section {number},m" for number in range(1, SECTIONS + 1)),
    )
    write_text(path, head + "\n".join("".join(f"{z:10.6f}" for z in row) for row in surface) + "\n")


def main(arguments: list[str] | None = None) -> int:
    """Write the surface of the options."""
    parser = argparse.ArgumentParser(prog="python -m scenarios.inputs.make_block", description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("stone_block.crg"), metavar="FILE.crg")
    parser.add_argument("--length", type=float, default=100.0, metavar="M", help="length [m]; %(default)s by default")
    parser.add_argument("--seed", type=int, default=1, metavar="N")
    options = parser.parse_args(arguments)
    if not 10.0 <= options.length <= 2000.0:
        parser.error(f"--length {options.length:g} m: must be 10 to 2000 m")
    write_block(options.output, options.length, options.seed)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
