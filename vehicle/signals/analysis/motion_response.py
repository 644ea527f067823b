"""FRFs to several simultaneous inputs; inputs that are scaled copies without a delay count as a single motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehicle.signals.analysis.dependence import common_motions
from vehicle.signals.analysis.frf import FrequencyResponse, frequency_responses
from vehicle.signals.analysis.periodic_record import whole_record_responses

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MotionResponse:
    """FRFs to an independent motion of the inputs.

    Attributes:
        motion: inputs of the motion to their factors; 1 for the first input. The FRFs refer to the first input, while
            the others move by their factors.
        response: FRFs; the coherence is the multiple coherence with all motions.
    """

    motion: Mapping[str, float]
    response: FrequencyResponse

    def __repr__(self) -> str:
        """One line."""
        return f"MotionResponse({', '.join(self.motion)}; {self.response!r})"

    @property
    def first(self) -> str:
        """Input to which the FRFs refer."""
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
        time_step: sampling interval [s].
        inputs: moving inputs, name to samples (n,).
        responses: k outputs, a sequence of (n,) or an array (k, n).
        labels: names of the inputs in messages.
        names: names of the responses in messages.
        band: lowest and highest frequency [Hz].
        rounding: rounding step of each input.
        window: length [s] of the Hann windows of H1; None for `whole_record_responses`.

    Returns:
        FRFs of each motion, in the order of the first inputs.

    Raises:
        DataError: the record is too short.
        DependentInputsError: an input is a delayed or filtered copy of another.
    """
    keys = list(inputs)
    groups = [{0: 1.0}]
    if len(keys) > 1:
        groups = common_motions(time_step, np.array([inputs[key] for key in keys]), [labels[k] for k in keys], band)
    first = [keys[next(iter(group))] for group in groups]
    driven, driven_labels = np.array([inputs[key] for key in first]), [labels[key] for key in first]
    if window is not None:
        responses_to = frequency_responses(
            time_step, driven, np.array(responses), window_s=window, band=band, input_names=driven_labels, names=names
        )
    else:
        steps = [rounding[key] for key in first]
        responses_to = whole_record_responses(
            time_step, driven, responses, band=band, names=names, input_names=driven_labels, rounding=steps
        )
    return tuple(
        MotionResponse(motion={keys[index]: factor for index, factor in group.items()}, response=response)
        for group, response in zip(groups, responses_to, strict=True)
    )
