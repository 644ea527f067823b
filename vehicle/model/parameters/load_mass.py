"""Loads that a vehicle file puts on its parts: passengers, luggage, fuel, a battery."""

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import quantity, validate
from vehicle.model.parameters.rigid_part import Part


@dataclass(frozen=True, kw_only=True, slots=True)
class Load:
    """Mass properties of a load; axes are those of the vehicle frame in the design position."""

    mass: float = quantity(
        "kg", "mass of the load; 0: no load", at_least=0.0, at_most=5000.0, why="a loaded van carries 3000 kg"
    )
    inertia: Point | None = quantity(
        "kg m2", "Ixx, Iyy, Izz about the load's own centre of gravity; a point mass by default", above=0.0,
        at_most=5000.0, length=3, default=None,
    )  # fmt: skip
    products: Point = quantity(
        "kg m2", "integrals of x y, z x, y z about the load's own centre of gravity", length=3, default=(0.0, 0.0, 0.0)
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.inertia is None and any(self.products):
            raise ConfigurationError(f"Load.products: found {list(self.products)} kg m2 without inertia; set both")
        try:
            Part(mass=1.0, inertia=self.inertia, products=self.products)
        except ConfigurationError as error:
            raise ConfigurationError(str(error).replace("Part.", "Load.", 1)) from None
