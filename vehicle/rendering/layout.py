"""Where things are in a frame."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.errors import ConfigurationError

SMALLEST = (320, 180)


@dataclass(frozen=True, kw_only=True, slots=True)
class Layout:
    """Frame of a film: the car at the left, a close-up at the right, traces along the bottom.

    Raises:
        ConfigurationError: a side is odd (H.264 with yuv420p halves both) or too small to read.
    """

    width: int
    """[pixel]"""
    height: int
    """[pixel]"""

    def __post_init__(self) -> None:
        if self.width % 2 or self.height % 2:
            raise ConfigurationError(
                f"film size: found {self.width} x {self.height}, both must be even; "
                f"give {self.width + self.width % 2} x {self.height + self.height % 2}"
            )
        if self.width < SMALLEST[0] or self.height < SMALLEST[1]:
            raise ConfigurationError(
                f"film size: found {self.width} x {self.height}, at least {SMALLEST[0]} x {SMALLEST[1]} can be read"
            )

    @property
    def view_height(self) -> int:
        """Height of the views of the car [pixel]."""
        return round(0.79 * self.height)

    @property
    def main_width(self) -> int:
        """Width of the view of the whole car [pixel]."""
        return round(0.70 * self.width)

    @property
    def trace_left(self) -> int:
        """Left edge of the traces [pixel]."""
        return round(0.19 * self.width)
