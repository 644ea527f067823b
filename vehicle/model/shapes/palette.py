"""Colours of the scene: muted, so that springs and dampers stand out."""

from typing import Final

from vehicle.model.shapes.shape import Colour

BODY: Final[Colour] = (0.50, 0.57, 0.65, 1.0)
LINING: Final[Colour] = (0.16, 0.17, 0.19, 1.0)
FLOOR: Final[Colour] = (0.33, 0.345, 0.36, 1.0)
GLASS: Final[Colour] = (0.16, 0.22, 0.27, 0.55)
TRIM: Final[Colour] = (0.10, 0.105, 0.115, 1.0)
CHROME: Final[Colour] = (0.64, 0.66, 0.68, 1.0)
HEADLAMP: Final[Colour] = (0.70, 0.75, 0.79, 1.0)
TAIL_LAMP: Final[Colour] = (0.55, 0.05, 0.06, 1.0)
SEAT: Final[Colour] = (0.24, 0.26, 0.31, 1.0)
RUBBER: Final[Colour] = (0.075, 0.075, 0.08, 1.0)
RIM: Final[Colour] = (0.60, 0.61, 0.63, 1.0)
STEEL: Final[Colour] = (0.56, 0.58, 0.60, 1.0)
DARK_STEEL: Final[Colour] = (0.27, 0.285, 0.30, 1.0)
CAST: Final[Colour] = (0.40, 0.39, 0.37, 1.0)
DISC: Final[Colour] = (0.66, 0.66, 0.65, 1.0)
CALIPER: Final[Colour] = (0.33, 0.35, 0.38, 1.0)
ALUMINIUM: Final[Colour] = (0.72, 0.73, 0.73, 1.0)
ENGINE_DARK: Final[Colour] = (0.20, 0.21, 0.22, 1.0)
SPRING: Final[Colour] = (0.86, 0.13, 0.11, 1.0)
DAMPER: Final[Colour] = (0.96, 0.74, 0.08, 1.0)
ROD: Final[Colour] = (0.88, 0.89, 0.91, 1.0)
LINK: Final[Colour] = (0.16, 0.42, 0.58, 1.0)
SHAKER: Final[Colour] = (0.17, 0.31, 0.42, 1.0)
PLATE: Final[Colour] = (0.60, 0.62, 0.64, 1.0)
STAND: Final[Colour] = (0.36, 0.39, 0.42, 1.0)
BED: Final[Colour] = (0.30, 0.315, 0.33, 1.0)
