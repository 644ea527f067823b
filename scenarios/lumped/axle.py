"""One axle of a half car: unsprung mass between suspension and tyre."""

from dataclasses import dataclass

from vehicle.model.parameters.quantity import Validated, quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class Axle(Validated):
    """Wheel mass, linear suspension and linear tyre of one end."""

    unsprung_mass: float = quantity("kg", "unsprung mass", above=0.0)
    suspension_stiffness: float = quantity("N/m", "suspension spring stiffness", above=0.0)
    suspension_damping: float = quantity("N s/m", "suspension damper coefficient", at_least=0.0)
    tyre_stiffness: float = quantity("N/m", "tyre stiffness", above=0.0)
    tyre_damping: float = quantity("N s/m", "tyre damper coefficient", at_least=0.0)
