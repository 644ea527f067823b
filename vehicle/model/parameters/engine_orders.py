"""Orders of a combustion engine: numbers of its crank drive and of its gas torque."""

import math
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point, cross, unit
from vehicle.model.parameters.quantity import quantity, validate

ENGINE, ORDERS = "engine", "orders"
"""Name of the part of a template that can have orders, and of their table in the instance."""


@dataclass(frozen=True, kw_only=True, slots=True)
class EngineOrders:
    """Inline four-stroke engine at constant speed: forces and moments on its block by pistons and gas.

    The block gets the inertia force of the pistons along the cylinders, their moment about the axis across, and minus
    the torque of gas and pistons about the crankshaft (`slider_crank`). The speed is `crank.rpm`.
    """

    cylinders: float = quantity("-", "number of cylinders in line", at_least=1.0, at_most=6.0)
    bore: float = quantity("m", "diameter of a cylinder", at_least=0.02, at_most=0.2)
    stroke: float = quantity("m", "stroke of a piston", at_least=0.02, at_most=0.25)
    rod: float = quantity("m", "length of the connecting rod between its bearings", at_least=0.03, at_most=0.6)
    reciprocating_mass: float = quantity(
        "kg",
        "oscillating mass of a cylinder: piston, pin, rings and small-end share of the connecting rod",
        at_least=0.0,
        at_most=5.0,
    )
    spacing: float = quantity("m", "distance of two cylinders along the crankshaft", at_least=0.0, at_most=0.4)
    firing: tuple[float, ...] = ()
    """firing order, for example [1, 3, 4, 2]; the crank axis points to the end of cylinder 1; required"""
    crank_axis: Point = quantity(
        "-", "direction of the crankshaft; it turns about it by the right-hand rule", length=3, default=(0.0, 1.0, 0.0)
    )
    cylinder_axis: Point = quantity("-", "direction of the cylinders", length=3, default=(0.0, 0.0, 1.0))
    torque: float = quantity(
        "N m", "mean gas torque of all cylinders together", at_least=0.0, at_most=2000.0, default=0.0
    )
    pressure: str | None = quantity(
        "-",
        "file with the absolute cylinder pressure against crank angle (0 at firing top dead centre); replaces torque "
        "and compression",
        is_file=True,
        default=None,
    )
    compression: float = quantity("-", "ratio of compression", at_least=5.0, at_most=25.0, default=10.5)
    balance_share: float = quantity(
        "-", "share of the force of order 2 that balance shafts cancel", at_least=0.0, at_most=1.0, default=0.0
    )
    counterweight_share: float = quantity(
        "-",
        "share of the piston masses that crankshaft counterweights balance in order 1; one half is usual",
        at_least=0.0,
        at_most=1.0,
        default=0.0,
    )
    backward_balance_share: float = quantity(
        "-",
        "share of the backward-rotating part of order 1 that a balance shaft cancels",
        at_least=0.0,
        at_most=1.0,
        default=0.0,
    )
    highest_order: float = quantity("-", "highest engine order included", at_least=1.0, at_most=16.0, default=6.0)
    at: Point | None = quantity(
        "m",
        "middle of the cylinders on the crankshaft; default: centre of gravity of the engine",
        length=3,
        default=None,
    )

    def __post_init__(self) -> None:
        validate(self)
        count = round(self.cylinders)
        if count != self.cylinders or sorted(self.firing) != list(range(1, count + 1)):
            raise ConfigurationError(
                f"EngineOrders.firing: found {list(self.firing)}, must name each of the {self.cylinders:g} "
                "cylinders once, for example [1, 3, 4, 2]"
            )
        if self.pressure is not None and self.torque:
            raise ConfigurationError(
                f"EngineOrders.torque: given twice, as {self.torque:g} N m and by the pressure file; keep only "
                "one of torque and pressure"
            )
        if self.rod <= 0.5 * self.stroke:
            raise ConfigurationError(f"EngineOrders.rod: found {self.rod:g} m, must be above half the stroke")
        across = math.hypot(*cross(self.crank_axis, self.cylinder_axis))
        if not across > 0.1 * math.hypot(*self.crank_axis) * math.hypot(*self.cylinder_axis):
            raise ConfigurationError(
                f"EngineOrders.cylinder_axis: found {list(self.cylinder_axis)}, must be across the crankshaft, "
                f"{list(self.crank_axis)}"
            )

    @property
    def axes(self) -> tuple[Point, Point, Point]:
        """Unit vectors of the crankshaft, of the cylinders, and across both: crankshaft x cylinders."""
        shaft, across = unit(self.crank_axis), unit(cross(self.crank_axis, self.cylinder_axis))
        return shaft, cross(across, shaft), across
