"""What the authors tuned by hand, with their starting values, and parameters given on the command line."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.errors import ConfigurationError
from vehicle.parameters.number_paths import value_of
from vehicle.parameters.vehicle import Vehicle
from vehicle.tuning.parameter import Parameter

AUTHORS = (
    # Section 3.1.3.2: stiffness of the suspension mount, measured at its driving point.
    Parameter(path="bushings.suspension_mount.stiffness.x", lower=1e6, upper=9e6, start=3.0e6),
    Parameter(path="bushings.suspension_mount.stiffness.y", lower=1e6, upper=9e6, start=3.0e6),
    Parameter(path="bushings.suspension_mount.stiffness.z", lower=2e5, upper=3e6, start=8.2e5),
    # Section 3.2.1.1: estimate; main spring: supplier.
    Parameter(path="stabilizer.torsional_stiffness", lower=5e2, upper=2e4, start=3e3),
    Parameter(path="main_spring.stiffness", lower=1e4, upper=6e4, start=2.5e4),
    # Section 3.2.1.3: engine mounts, measured with a hammer.
    Parameter(path="bushings.linear_mount.stiffness.z", lower=1e5, upper=2e6, start=6e5),
    Parameter(path="bushings.torque_arm_engine.stiffness.x", lower=1e5, upper=2e6, start=6.5e5),
    # Section 3.1.3.2: damper of the quarter car.
    Parameter(path="damper.viscous", lower=3e2, upper=8e3, start=1500.0),
    Parameter(path="damper.coulomb_friction", lower=15.0, upper=400.0, start=75.0),
    # Appendix F prints it with an exponent that nobody can read: do the data tell?
    Parameter(path="bushings.torque_arm_body.stiffness.z", lower=1.2e4, upper=1.2e6, start=1.3e5),
)
"""Section "starting values before tuning" of source 1; the bounds are ours and far from start and result."""

SLIDING = ("damper.viscous", "damper.coulomb_friction")
"""What a damper that sticks does not show: the authors tuned them on bumps (section 3.2.2)."""

QUICK = ("bushings.suspension_mount.stiffness.z", "damper.coulomb_friction")
"""Fitted with --quick; the others stay at the values of the vehicle file, which the data then have too."""

TEXT = "PATH=LOWER:UPPER or PATH=LOWER:UPPER:START"


def parse_parameters(texts: Sequence[str], vehicle: Vehicle) -> tuple[Parameter, ...]:
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
        found.append(Parameter(path=path, lower=values[0], upper=values[1], start=start))
    return tuple(found)
