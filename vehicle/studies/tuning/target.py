"""Measurements that a model is compared with in a fit."""

from collections.abc import Mapping
from typing import Any, Protocol

from vehicle.arrays import Vector


class Target(Protocol):
    """Measurement whose residuals are computed in two steps, so that delays need no further run of the model."""

    @property
    def rows(self) -> tuple[str, ...]:
        """Return the names of the rows of the residuals."""

    @property
    def recorded(self) -> tuple[str, ...]:
        """Return the names of the channels."""

    @property
    def half_sample(self) -> float:
        """Return half the sampling interval of the measurement [s]; 0 if unknown."""

    def response(self, model: Any, /) -> Any:
        """Return the response of a model, without delays."""

    def misfit(self, response: Any, groups: Mapping[str, float], lags: Mapping[str, float], /) -> Vector:
        """Return residuals over their assumed standard deviation, (rows, samples); 0 where a value is excluded.

        Args:
            response: result of `response`.
            groups: group of channels to its delay [s].
            lags: channel to a further delay [s].
        """
