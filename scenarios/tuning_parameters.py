"""What the authors tuned by hand, with their starting values, and parameters given on the command line."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.errors import ConfigurationError
from vehicle.parameters.paths import value_of
from vehicle.parameters.ranges import Range
from vehicle.parameters.vehicle import Vehicle

AUTHORS = (
    # Section 3.1.3.2: stiffness of the suspension mount, measured at its driving point.
    Range(path="bushings.suspension_mount.stiffness.x", low=1e6, high=9e6, start=3.0e6),
    Range(path="bushings.suspension_mount.stiffness.y", low=1e6, high=9e6, start=3.0e6),
    Range(path="bushings.suspension_mount.stiffness.z", low=2e5, high=3e6, start=8.2e5),
    # Section 3.2.1.1: estimate; main spring: supplier.
    Range(path="stabilizer.torsional_stiffness", low=5e2, high=2e4, start=3e3),
    Range(path="main_spring.stiffness", low=1e4, high=6e4, start=2.5e4),
    # Section 3.2.1.3: engine mounts, measured with a hammer.
    Range(path="bushings.linear_mount.stiffness.z", low=1e5, high=2e6, start=6e5),
    Range(path="bushings.torque_arm_engine.stiffness.x", low=1e5, high=2e6, start=6.5e5),
    # Section 3.1.3.2: damper of the quarter car.
    Range(path="damper.viscous", low=3e2, high=8e3, start=1500.0),
    Range(path="damper.coulomb_friction", low=15.0, high=400.0, start=75.0),
    # Appendix F prints it with an exponent that nobody can read: do the data tell?
    Range(path="bushings.torque_arm_body.stiffness.z", low=1.2e4, high=1.2e6, start=1.3e5),
)
"""Section "starting values before tuning" of source 1; the bounds are ours and far from start and result."""

SLIDING = ("damper.viscous", "damper.coulomb_friction")
"""What a damper that sticks does not show: the authors tuned them on bumps (section 3.2.2)."""

QUICK = ("bushings.suspension_mount.stiffness.z", "damper.coulomb_friction")
"""Fitted with --quick; the others stay at the values of the vehicle file, which the data then have too."""

TEXT = "PATH=LOWER:UPPER or PATH=LOWER:UPPER:START"


def parse_parameters(texts: Sequence[str], vehicle: Vehicle) -> tuple[Range, ...]:
    """Parameters of the option --fit; without a start they begin at the value of the vehicle.

    Raises:
        ConfigurationError: a text, a path or a bound is wrong.
    """
    found = []
    for text in texts:
        path, separator, numbers = text.partition("=")
        try:
            values = [float(number) for number in numbers.split(":")]
        except ValueError:
            values = []
        if not separator or len(values) not in (2, 3):
            raise ConfigurationError(f"--fit {text}: needed is {TEXT}, as in damper.viscous=500:5000:1500")
        begin = value_of(vehicle, path)
        start = values[2] if len(values) > 2 else begin
        found.append(Range(path=path, low=values[0], high=values[1], start=start))
    return tuple(found)
