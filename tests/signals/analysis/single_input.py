"""FRFs to a single input, for tests of the estimator of several inputs."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vehicle.signals.analysis.frf import FrequencyResponse, frequency_responses
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.analysis.samples import checked_signals


def local_rational_response(
    time_step: float,
    excitation: ArrayLike,
    responses: ArrayLike,
    *,
    band: tuple[float, float] = (1.0, 50.0),
    resolution: float = 0.1,
    names: Sequence[str] | None = None,
    rounding: float = 0.0,
) -> FrequencyResponse:
    """Estimate the FRFs of a whole random record to one input; for the arguments see `local_rational_responses`."""
    estimates = local_rational_responses(
        time_step,
        checked_signals("excitation", excitation)[:1],
        responses,
        band=band,
        resolution=resolution,
        names=names,
        input_names=("excitation",),
        rounding=(rounding,),
    )
    return estimates[0]


def frequency_response(
    time_step: float, excitation: ArrayLike, responses: ArrayLike, **options: Any
) -> FrequencyResponse:
    """Estimate the FRFs to one excitation (n,); for the options see `frequency_responses`."""
    inputs = np.asarray(excitation, dtype=np.float64)[None]
    return frequency_responses(time_step, inputs, responses, input_names=("excitation",), **options)[0]
