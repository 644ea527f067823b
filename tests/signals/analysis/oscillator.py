"""A mass on a spring and a damper on a moving plate: what the FRF, peak and simulation tests compare with."""

import numpy as np

FREQUENCY = 8.0
DAMPING = 0.1


def transmissibility(frequency, natural=FREQUENCY, damping=DAMPING):
    """Displacement of the mass over displacement of the plate."""
    ratio = frequency / natural
    return (1 + 2j * damping * ratio) / (1 - ratio**2 + 2j * damping * ratio)


def state_space(natural=FREQUENCY, damping=DAMPING):
    """x'' + 2 zeta w x' + w^2 x = 2 zeta w u' + w^2 u in a form that needs u only."""
    w = 2 * np.pi * natural
    a = np.array([[0.0, 1.0], [-(w**2), -2 * damping * w]])
    b = np.array([[2 * damping * w], [w**2 - (2 * damping * w) ** 2]])
    return a, b, np.array([[1.0, 0.0]]), np.array([[0.0]])


def stationary_response(excitation, time_step, transfer):
    """Exact steady state under a signal that repeats itself for ever: the product in the frequency domain."""
    lines = np.fft.rfftfreq(excitation.size, time_step)
    return np.fft.irfft(np.fft.rfft(excitation) * transfer(lines), excitation.size)
