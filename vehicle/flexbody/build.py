"""Exports the trimmed body of a vehicle as a modal superelement.

python -m vehicle.flexbody.build [--vehicle FILE] [--output FILE] [--fit]

With `--fit` the section factors are fitted again from the nominal sections (minutes) and printed for the design.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle.flexbody.body_design import read_design
from vehicle.flexbody.body_frame import body_frame
from vehicle.flexbody.fit import STAGES, fit_factors
from vehicle.flexbody.superelement_file import write_superelement
from vehicle.parameters.shipped import FOCUS_FILE
from vehicle.parameters.vehicle import load_vehicle

BODY_DESIGN = FOCUS_FILE.with_name("body_design.toml")
TRIMMED_BODY = FOCUS_FILE.with_name("trimmed_body.toml")
"""The superelement of the shipped design on the shipped car, for those who want it as it was fitted."""


def main() -> None:
    """Write the data file."""
    parser = argparse.ArgumentParser(description="Compute the trimmed body of a vehicle and write its superelement.")
    parser.add_argument("--vehicle", type=Path, help="vehicle file (default: the car of source 1)")
    parser.add_argument("--design", type=Path, default=BODY_DESIGN, help="body design (default: the shipped one)")
    parser.add_argument("--output", type=Path, default=TRIMMED_BODY, help="file to write (default: the shipped one)")
    parser.add_argument("--fit", action="store_true", help="fit the section factors again, from the nominal sections")
    arguments = parser.parse_args()
    vehicle, design = load_vehicle(arguments.vehicle), read_design(arguments.design)
    frame, factors = body_frame(design, vehicle.points, vehicle.body), design.factors
    if arguments.fit:
        factors = fit_factors(frame, dict.fromkeys(factors, 1.0), STAGES)
        print("\n".join(f"{group}: {factors[group]:.5g}" for group in design.fitted_groups))
    write_superelement(arguments.output, frame.superelement(factors))


if __name__ == "__main__":
    main()
