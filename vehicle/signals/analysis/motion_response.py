"""FRFs to several simultaneous inputs; inputs that are scaled copies without a delay count as a single motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.names import in_order
from vehicle.signals.analysis.dependence import common_motions
from vehicle.signals.analysis.frf import FrequencyResponse, frequency_responses
from vehicle.signals.analysis.periodic_record import whole_record_responses
from vehicle.signals.analysis.response_name import ResponseName, plates_of
from vehicle.signals.analysis.samples import Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MotionResponse:
    """FRFs to an independent motion of the inputs.

    Attributes:
        motion: wheels of the plates that move together to their factors; 1 for the first. The FRFs refer to the first
            plate, while the others move by their factors.
        response: FRFs; the coherence is the multiple coherence with all motions.
    """

    motion: Mapping[str, float]
    response: FrequencyResponse

    def __repr__(self) -> str:
        """One line."""
        return f"MotionResponse({', '.join(self.motion)}; {self.response!r})"

    @property
    def first(self) -> str:
        """Wheel of the plate to which the FRFs refer."""
        return next(iter(self.motion))

    @property
    def input(self) -> str:
        """Return the name of the input, as "plate_fr" or "plate_fr+plate_fl"."""
        return self.named("").input

    def named(self, output: str) -> ResponseName:
        """Return the name of the FRF of an output."""
        return ResponseName(output, plates_of(self.motion))


def motion_responses(
    time_step: float,
    inputs: Mapping[str, Vector],
    responses: Sequence[Vector] | Vector,
    *,
    names: Sequence[str],
    band: tuple[float, float],
    rounding: Mapping[str, float] | None = None,
    window: float | None = None,
    resolution: float = 0.1,
    motions: Sequence[Mapping[str, float]] | None = None,
) -> tuple[MotionResponse, ...]:
    """Estimate the FRFs to every independent motion of the plates; their order in the record changes nothing.

    Args:
        time_step: sampling interval [s].
        inputs: displacements of the moving plates, wheel to samples (n,).
        responses: k outputs, a sequence of (n,) or an array (k, n).
        names: names of the responses in messages.
        band: lowest and highest frequency [Hz].
        rounding: rounding step of each plate; estimated from the samples by default.
        window: length [s] of the Hann windows of H1; None for `whole_record_responses`.
        resolution: see `whole_record_responses`.
        motions: independent motions, if known; by default found in the samples.

    Returns:
        FRFs of each motion, in the order of the wheels in files.

    Raises:
        DataError: the record is too short.
        DependentInputsError: an input is a delayed or filtered copy of another.
    """
    keys = in_order(inputs)
    labels = [f"plate_{key}_displacement" for key in keys]
    if motions is None:
        groups = [{0: 1.0}]
        if len(keys) > 1:
            groups = common_motions(time_step, [inputs[key] for key in keys], labels, band)
        motions = [{keys[index]: factor for index, factor in group.items()} for group in groups]
    first = [next(iter(motion)) for motion in motions]
    driven, driven_labels = np.array([inputs[key] for key in first]), [labels[keys.index(key)] for key in first]
    if window is not None:
        responses_to = frequency_responses(
            time_step, driven, np.array(responses), window_s=window, band=band, input_names=driven_labels, names=names
        )
    else:
        steps = None if rounding is None else [rounding[key] for key in first]
        responses_to = whole_record_responses(
            time_step, driven, responses, band=band, resolution=resolution, names=names, input_names=driven_labels,
            rounding=steps,
        )  # fmt: skip
    return tuple(
        MotionResponse(motion=motion, response=response) for motion, response in zip(motions, responses_to, strict=True)
    )
