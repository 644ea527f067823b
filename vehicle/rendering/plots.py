"""The pictures of a run."""

from vehicle.rendering.frf_plot import plot_frf
from vehicle.rendering.time_plot import plot_time

__all__ = ["plot_frf", "plot_time"]
