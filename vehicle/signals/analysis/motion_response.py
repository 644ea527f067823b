"""FRFs to each of several inputs that act at once; inputs that move together without a delay count as one motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehicle.signals.analysis.dependence import common_motions
from vehicle.signals.analysis.frf import FrequencyResponse, frequency_responses
from vehicle.signals.analysis.local_rational import local_rational_responses

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MotionResponse:
    """FRFs to one independent motion.

    Attributes:
        motion: inputs that make it to their factors, 1 of the first: the FRFs are those to the first while the others
            move by their factors.
        response: the FRFs; the coherence is that with all motions together.
    """

    motion: Mapping[str, float]
    response: FrequencyResponse

    @property
    def first(self) -> str:
        """The input that the FRFs are referred to."""
        return next(iter(self.motion))


def motion_responses(
    time_step: float,
    inputs: Mapping[str, Real],
    responses: Sequence[Real] | Real,
    *,
    labels: Mapping[str, str],
    names: Sequence[str],
    band: tuple[float, float],
    rounding: Mapping[str, float],
    window: float | None = None,
) -> tuple[MotionResponse, ...]:
    """Estimate the FRFs to every independent motion of the inputs.

    Args:
        time_step: [s].
        inputs: that move, name to samples (n,).
        responses: k of shape (n,), or (k, n).
        labels: of the inputs, for messages.
        names: of the responses, for messages.
        band: lowest and highest frequency [Hz].
        rounding: step to which each input was rounded.
        window: None for local rational models on the whole record; length [s] of the Hann windows of H1.

    Returns:
        One for each motion, in the order of their first inputs.

    Raises:
        DataError: the record is too short.
        DependentInputsError: an input is a delayed or filtered copy of another.
    """
    keys = list(inputs)
    groups = [{0: 1.0}]
    if len(keys) > 1:
        groups = common_motions(time_step, np.array([inputs[key] for key in keys]), [labels[k] for k in keys], band)
    first = [keys[next(iter(group))] for group in groups]
    driven, called = np.array([inputs[key] for key in first]), [labels[key] for key in first]
    if window is not None:
        found = frequency_responses(
            time_step, driven, np.array(responses), window_s=window, band=band, input_names=called, names=names
        )
    else:
        steps = [rounding[key] for key in first]
        found = local_rational_responses(
            time_step, driven, responses, band=band, names=names, input_names=called, rounding=steps
        )
    return tuple(
        MotionResponse(motion={keys[index]: factor for index, factor in group.items()}, response=response)
        for group, response in zip(groups, found, strict=True)
    )
