"""Peak of a resonance in a run-up: how much lower and later it is than at constant speeds.

A harmonic force passes the natural frequency f of a mode with the damping ratio z at the rate r [Hz/s]. The amplitude a
of the mode over its steady peak obeys, with the time u = 2 pi f z t from the instant of resonance,

    da/du = -(1 - i b u) a + 1,    b = r/(2 pi f^2 z^2),

whose solution from rest is a(u) = integral over s > 0 of exp(-s + i b (u s - s^2/2)) ds, in closed form

    a(u) = sqrt(pi/(2 i b)) w((b u + i)/sqrt(2 i b)),    w(x) = exp(-x^2) erfc(-i x), the Faddeeva function.

An order cut reads it through a window. The acceleration is (2 pi f)^2 a plus a share 2 z of the force.
Source: Lewis, Vibration during acceleration through a critical speed, Trans. ASME 54 (1932) 253-261; w: NIST Digital
Library of Mathematical Functions, 7.7.2.
"""

import numpy as np
import scipy


def run_up_peak(frequency: float, damping: float, rate: float, window: float = 0.0) -> tuple[float, float]:
    """Return the peak of the amplitude of a mode in a run-up over its steady peak, and how late it comes [Hz].

    Args:
        frequency: natural frequency f [Hz].
        damping: damping ratio z [-].
        rate: rate of the frequency of the force [Hz/s], without its sign.
        window: length of the Hann window through which the amplitude is read [s]; 0 for none.
    """
    b, scale = rate / (2.0 * np.pi * (frequency * damping) ** 2), 2.0 * np.pi * frequency * damping
    # The peak is late by less than a few bandwidths, and by the width of the chirp where that is larger.
    # Far above the bandwidth it is that of an undamped mode, at the first maximum of the chirp.
    ends = 3.0 / b + 6.0 / np.sqrt(b) + 3.0 / (1.0 + b) + 0.5 * window * scale
    time = np.linspace(-ends, ends, 801)
    root = np.sqrt(2j * b)
    amplitude = np.sqrt(np.pi) / root * scipy.special.wofz((b * time + 1j) / root)
    width = round(window * scale / (time[1] - time[0]))
    if width > 1:
        shape = np.hanning(width + 2)[1:-1]
        amplitude = np.convolve(amplitude, shape / shape.sum(), mode="same")
    top = int(np.argmax(np.abs(amplitude)))
    return float(np.abs(amplitude[top])), float(rate * time[top] / scale)
