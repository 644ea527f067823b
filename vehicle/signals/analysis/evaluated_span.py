"""Samples of a record that are evaluated: comfort, slip shares, spectra and figures of a run all use this span.

A run of the length T has N + 1 samples, t = 0 to T. Its span from t_0 to T consists of n = round((T - t_0)/dt) samples,
without the last one: that closes the span, and on a road that repeats after the span it is the first one again. The
lines of the spectrum then lie at k/(n dt) = k/(T - t_0); with n + 1 samples, for example, that at 2 Hz would fall to
1.9998 Hz, out of the band. A measured record is evaluated whole: its last sample is not known to close a span.
"""


def evaluated_span(samples: int, time_step: float, skip: float, *, closed: bool = True) -> slice:
    """Return the evaluated samples.

    Args:
        samples: number of samples of the record.
        time_step: sampling interval [s].
        skip: time before the span [s].
        closed: the last sample closes the span, as in a run; False for a measured record.
    """
    return slice(round(skip / time_step), samples - closed)
