"""Run of the linear twin of a car: the car with viscous dampers of the same energy, on the road of a finished run.

The twin (`vehicle.engines.reduced.linear_twin`) has the damping constants c = mean((F - mean F) v)/mean(v^2) of the
evaluated span of the run. On a road that repeats after this span its steady state is periodic, so the run is a product
on the lines k/T of the period,

    Y(f) = sum over plates of H(f, c) Z(f),

exact without time steps, and its mean squares, weighted or not, are sums over the lines. The twin lacks the nonlinear
parts of the car: the memory of friction, laws over displacement beyond their tangent, and the present tyre load on
slopes. It also lacks lines above `HIGHEST`.

Sources: see `vehicle.engines.reduced.equivalent_damping`.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.equivalent_damping import equivalent_damping
from vehicle.engines.reduced.linear_twin import LinearTwin, linear_twin
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.model.parameters.force_elements import Damper
from vehicle.threads import one_blas_thread

HIGHEST = 100.0
"""Highest frequency of the twin [Hz], the upper limit of the weightings of ISO 2631-1."""


def damping_of_run(model: PoleModel, laws: Sequence[Damper], record: Mapping[str, Vector], span: slice) -> Vector:
    """Return the damping constants of the twin [N s/m]; (d,).

    Args:
        model: pole model of the car.
        laws: laws of the dampers.
        record: channels of the run, with forces and velocities of the dampers.
        span: evaluated samples.
    """
    return np.array(
        [
            equivalent_damping(law, record[f"{name}_velocity"][span], record[f"{name}_force"][span])
            for name, law in zip(model.matrices.damper_names, laws, strict=True)
        ]
    )


@one_blas_thread()
def period_twin(
    model: PoleModel, plates: Mapping[str, Vector], period: float, channels: Sequence[str], samples: int
) -> LinearTwin:
    """Return the responses of the twin to the lines of one period of the plates, for any damping constants.

    Args:
        model: pole model of the car.
        plates: wheel to displacement over one period [m]; other plates do not move.
        period: length of the period T [s].
        channels: accelerations [m/s2], dynamic tyre forces [N], velocities [m/s] and forces [N] of the dampers.
        samples: number of samples of a record of one period.

    Returns:
        The twin at the lines k/T up to `HIGHEST`; its outputs are the accelerations and tyre forces in the order of
        `channels`, to one input, scaled so that |line|^2 = S df.
    """
    count = next(iter(plates.values())).size
    lines = np.arange(1, min(int(HIGHEST * period), (min(count, samples) - 1) // 2) + 1)
    spectra = np.zeros((len(model.matrices.system.inputs), 1, lines.size), dtype=np.complex128)  # (w, 1, m)
    for row, wheel in enumerate(model.matrices.system.inputs):
        if wheel in plates:
            spectra[row, 0] = np.fft.rfft(plates[wheel])[lines] * (np.sqrt(2.0) / count)
    return linear_twin(model, _outputs(channels), lines / period, spectra)


def _outputs(channels: Sequence[str]) -> list[str]:
    return [name for name in channels if name.startswith("tyre_") or "_acc_" in name]


def twin_lines(twin: LinearTwin, dampers: Sequence[str], damping: Vector, channels: Sequence[str]) -> Complex:
    """Return the lines of channels of a twin in its steady state, |line|^2 = S df; (k, m).

    Args:
        twin: see `period_twin`, with its channels.
        dampers: names of the dampers.
        damping: damping constants c [N s/m]; (d,).
        channels: names of the channels.
    """
    velocity = twin.velocities(damping)
    response = twin.with_velocities(damping, velocity)[:, 0]
    rows = dict(zip(_outputs(channels), response, strict=True))
    rows |= {f"{name}_velocity": row for name, row in zip(dampers, velocity[:, 0], strict=True)}
    rows |= {f"{name}_force": c * row for name, c, row in zip(dampers, damping, velocity[:, 0], strict=True)}
    return np.array([rows[name] for name in channels])


def twin_run(
    model: PoleModel,
    damping: Vector,
    plates: Mapping[str, Vector],
    period: float,
    channels: Sequence[str],
    samples: int,
) -> dict[str, Vector]:
    """Return the steady state of the twin over one period of the plates as histories, (n,) each.

    Args:
        model, plates, period, channels: see `period_twin`.
        damping: damping constants c [N s/m]; (d,).
        samples: number of samples n of the result.
    """
    twin = period_twin(model, plates, period, channels, samples)
    lines = twin_lines(twin, model.matrices.damper_names, damping, channels)
    whole = np.zeros((len(channels), samples // 2 + 1), dtype=np.complex128)
    # A line at k/T and its mirror image.
    whole[:, 1 : lines.shape[1] + 1] = lines * (samples / np.sqrt(2.0))
    return dict(zip(channels, np.fft.irfft(whole, samples, axis=1), strict=True))
