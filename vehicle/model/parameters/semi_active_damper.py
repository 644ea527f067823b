"""Damper with a controlled coefficient: limits, gains of the control laws, delay and rate."""

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import quantity, validate

PASSIVE = "passive"
"""Name of the law of an uncontrolled damper."""

LAWS = ("skyhook_on_off", "skyhook", "groundhook_on_off", "groundhook", "hybrid_on_off", "hybrid")
"""Names of the laws of `vehicle.model.laws.control_laws`."""

GAINS = {
    "skyhook": ("skyhook_damping",),
    "groundhook": ("groundhook_damping",),
    "hybrid_on_off": ("skyhook_share",),
    "hybrid": ("skyhook_damping", "groundhook_damping", "skyhook_share"),
}
"""Gains that a law needs; the other laws have none."""

FMU = "fmu"
"""Name of the law of a controller in an FMU."""

CONTROLLER_PARAMETERS = (
    *("minimum_damping", "maximum_damping", "skyhook_damping", "groundhook_damping", "skyhook_share"),
)
"""Values of the table that a parameter of the same name in a controller FMU takes."""

AT_ONCE = 1e12
"""Rate of the coefficient [N s/m per s] that means no limit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SemiActiveDamper:
    """Limits of an adjustable damper and gains of its control law; without effect if the law is "passive".

    The coefficient replaces the viscous law of the damper: F = c v, cmin <= c <= cmax. Friction, gas force and stop
    remain.
    """

    law: str = quantity("-", "control law", choices=(PASSIVE, *LAWS, FMU), default=PASSIVE)
    fmu: str | None = quantity("-", "file of the FMU that controls the damper (law = fmu)", is_file=True, default=None)
    fmu_sha256: str | None = quantity(
        "-", "SHA-256 of the FMU; each user permits it to run with: vehicle trust", default=None
    )
    minimum_damping: float = quantity("N s/m", "softest setting cmin", at_least=0.0)
    maximum_damping: float = quantity("N s/m", "firmest setting cmax", above=0.0, at_most=1e6)
    control_period: float = quantity("s", "time between two settings of the dampers", above=0.0, at_most=1.0)
    delay: float = quantity(
        "s",
        "from the reading of the sensors to the setting of the damper",
        default=0.0,
        at_least=0.0,
        at_most=1.0,
        why="electronics and valve take 5 to 30 ms",
    )
    rate: float = quantity(
        "N s/m per s",
        "fastest change of the damping coefficient; 1e12: no limit",
        default=AT_ONCE,
        above=0.0,
        at_most=AT_ONCE,
    )
    skyhook_damping: float | None = quantity(
        "N s/m", "damping constant of the skyhook, between body and sky", at_least=0.0, default=None
    )
    groundhook_damping: float | None = quantity(
        "N s/m", "damping constant of the groundhook, between wheel and ground", at_least=0.0, default=None
    )
    skyhook_share: float | None = quantity(
        "-", "share of skyhook in the hybrid law, the rest is groundhook", at_least=0.0, at_most=1.0, default=None
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.law == FMU and self.fmu is None:
            raise ConfigurationError('SemiActiveDamper.fmu: missing; law = fmu needs fmu = "FILE.fmu"')
        for name in GAINS.get(self.law, ()):
            if getattr(self, name) is None:
                raise ConfigurationError(f"SemiActiveDamper.{name}: missing; law = {self.law} needs it")
        if self.maximum_damping < self.minimum_damping:
            raise ConfigurationError(
                f"SemiActiveDamper.maximum_damping: found {self.maximum_damping!r} N s/m, "
                f"must be at least minimum_damping {self.minimum_damping!r} N s/m"
            )
