"""Two masses on a shaken base, whose FRFs are known in closed form: a model that a fit can be checked with."""

import numpy as np

from vehicle.signals.analysis.frf_agreement import log_ratio

FREQUENCY = np.linspace(1.0, 25.0, 60)
TRUE = {"lower": 2.5e5, "upper": 3e4, "damping": 1500.0}
SIGMA = 0.03


def response(values, frequency=FREQUENCY):
    """Accelerations of both masses over the displacement of the base, (2, m).

    A wheel of 45 kg on a tyre spring, a body of 180 kg on a spring and a damper. A further spring in series with the
    tyre ("rim") makes k = lower rim / (lower + rim), of which only the total can be told.
    """
    lower, upper, damping = (values[name] for name in ("lower", "upper", "damping"))
    if "rim" in values:
        lower = lower * values["rim"] / (lower + values["rim"])
    s = 2j * np.pi * frequency
    strut = upper + s * damping
    wheel_line, body_line = 45.0 * s**2 + lower + strut, 180.0 * s**2 + strut
    determinant = wheel_line * body_line - strut**2
    return s**2 * lower * np.stack([body_line, strut]) / determinant


class MeasuredMasses:
    """The FRFs as a target; noise of a standard deviation SIGMA on ln|H| and on the phase."""

    rows = ("wheel, magnitude", "wheel, phase", "body, magnitude", "body, phase")
    recorded: tuple[str, ...] = ()
    half_sample: float = 0.0

    def __init__(self, true=TRUE, *, seed=0, sigma=SIGMA, assumed=SIGMA):
        real, imaginary = np.random.default_rng(seed).standard_normal((2, 2, FREQUENCY.size))
        self.data = response(true) * np.exp(sigma * (real + 1j * imaginary))
        self.assumed = assumed

    def residuals(self, values):
        logarithm = log_ratio(self.data, response(values)) / self.assumed
        return np.stack([logarithm.real, logarithm.imag], axis=1).reshape(4, -1)

    def response(self, values):
        return self.residuals(values)

    def misfit(self, residuals, groups, lags):
        return residuals
