"""Computes the trimmed body from its wireframe and writes `trimmed_body.toml`.

python -m vehicle.flexbody.build [--output FILE] [--fit]

With `--fit` the section factors are fitted again from the nominal sections (minutes) and printed for `sections.py`.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from vehicle.flexbody.attachment import attachment_stiffness
from vehicle.flexbody.body_frame import trimmed_body_frame
from vehicle.flexbody.fit import MODE_COUNT, STAGES, fit_factors, fitted_groups, stored_factors
from vehicle.flexbody.mode_names import mode_names
from vehicle.flexbody.superelement import Superelement
from vehicle.flexbody.superelement_file import write_superelement

TRIMMED_BODY = Path(__file__).with_name("trimmed_body.toml")
"""The data file that the package ships."""
_DAMPING_RATIO = 0.03  # assumed for every mode: trimmed bodies have 2 to 4 %, and the thesis gives none
_PROVENANCE = (
    "Space frame of beams, not a measurement: the modal model of the thesis (Bommer, TU Eindhoven 2006) is not public. "
    "Published and met: 43 nodes, 9 modes from 19 to 43 Hz, mass, CoG, Iyy, Izz, Izx, and Ixx 1200 ('improved'). "
    "Not met on purpose: the products Ixy 82 and Iyz -50 kg m2. They were measured separately from the modes, no mode "
    "shape is published, and a body with them has lopsided modes; so the elastic model is symmetric about y = 0, and "
    "the rigid inertia of the car takes the published products. "
    "Assumed: geometry, nominal sections, guess of the mass distribution, modal damping 0.03, attachment stiffness. "
    "Fitted: section factors, to the first and last frequency, to a torsion mode at 25.5 Hz and to a quiet seat rail; "
    "torsion mode and the strut tops' stiffness along z, to the vertical wheel mode at 28 Hz of the complete car; the "
    "stiffness at the engine mounts, to the engine modes of 10 to 20 Hz. "
    "Published results used: these frequencies, and the seat-rail levels of figures 4.1 and 4.2 (limits of the rail's "
    "amplitudes). Seen while limits and nominal sections were chosen, in no residual: comfort figures 4.3 to 4.12, "
    "slip shares, bump figures 3.13 to 3.18. None of these counts as predicted. "
    "Written by python -m vehicle.flexbody.build."
)


def trimmed_body(factors: Mapping[str, float] | None = None) -> Superelement:
    """The trimmed body computed from wireframe, sections and masses; factors of the sections: those stored."""
    frame = trimmed_body_frame()
    frequencies, shapes = frame.modes(stored_factors() if factors is None else factors, MODE_COUNT)
    return Superelement(
        name="trimmed_body",
        nodes=frame.nodes,
        positions=frame.positions,
        edges=frame.edges,
        node_mass=frame.node_mass,
        frequencies=frequencies,
        damping_ratio=np.full(MODE_COUNT, _DAMPING_RATIO),
        shapes=shapes,
        attachment_stiffness=attachment_stiffness(),
        mode_names=mode_names(shapes, frame.nodes, frame.positions, frame.node_mass),
        provenance=_PROVENANCE,
    )


def main() -> None:
    """Write the data file."""
    parser = argparse.ArgumentParser(description="Compute the trimmed body and write its data file.")
    parser.add_argument("--output", type=Path, default=TRIMMED_BODY, help="file to write (default: the shipped one)")
    parser.add_argument("--fit", action="store_true", help="fit the section factors again, from the nominal sections")
    arguments = parser.parse_args()
    factors = None
    if arguments.fit:
        factors = fit_factors(trimmed_body_frame(), dict.fromkeys(stored_factors(), 1.0), STAGES)
        print("\n".join(f"{group}: {factors[group]:.5g}" for group in fitted_groups()))
    write_superelement(arguments.output, trimmed_body(factors))


if __name__ == "__main__":
    main()
