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
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.model.parameters.force_elements import Damper
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.excitation.signal import Signal
from vehicle.threads import one_blas_thread

HIGHEST = 100.0
"""Highest frequency of the twin [Hz], the upper limit of the weightings of ISO 2631-1."""

FALL_S, PAUSE_S = 1.0, 4.0
"""Times [s] in which the plates return to rest after the record, and in which the twin comes to rest, until it repeats:
a motion of 1 Hz with a damping ratio of 0.2 decays to 0.7 %."""

FALL_M = 0.1
"""Height of the plates from which they return more slowly [m], with the same acceleration as from this height, at most
0.5 m/s2: a profile can end on a hill, and a fall of 100 m in `FALL_S` would shake the twin for the whole record."""

LAW = "law_"
"""Prefix of the displacement of a law as an output of the twin."""

LINES_AT_ONCE = 2**14
"""Lines that are computed together, which limits the memory: a number for each pole at each line."""


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
def twin_lines(
    model: PoleModel,
    dampings: Sequence[Vector],
    roads: Sequence[Mapping[str, Vector]],
    period: float,
    channels: Sequence[str],
    samples: int,
) -> tuple[Vector, Complex]:
    """Return the steady state of twins with the same poles as lines k/T up to `HIGHEST`.

    Args:
        model: pole model of the cars.
        dampings: damping constants c of each twin [N s/m]; (d,) each.
        roads: for each of i roads, wheel to displacement of its plate over one period [m]; other plates do not move.
        period: length of the period T [s].
        channels: accelerations [m/s2], dynamic tyre forces [N], velocities [m/s] and forces [N] of the dampers, and
            "law_N" for the displacement of the law N of the model [m].
        samples: number of samples of a record of one period.

    Returns:
        Frequency [Hz], (m,), and lines of the twins, |line|^2 = S df; (c, i, k, m).
    """
    names = model.matrices.damper_names
    outputs = [name for name in channels if name.startswith("tyre_") or "_acc_" in name]
    laws = [name for name in channels if name.startswith(LAW)]
    further = model.law_outputs.part([int(name.removeprefix(LAW)) for name in laws]) if laws else None
    count = next(iter(roads[0].values())).size
    lines = np.arange(1, min(int(HIGHEST * period), (min(count, samples) - 1) // 2) + 1)
    spectra = np.zeros((len(model.matrices.system.inputs), len(roads), lines.size), dtype=np.complex128)  # (w, i, m)
    for row, wheel in enumerate(model.matrices.system.inputs):
        for road, plates in enumerate(roads):
            if wheel in plates:
                spectra[row, road] = np.fft.rfft(plates[wheel])[lines] * (np.sqrt(2.0) / count)
    result = np.empty((len(dampings), len(roads), len(channels), lines.size), dtype=np.complex128)
    for first in range(0, lines.size, LINES_AT_ONCE):
        part = slice(first, first + LINES_AT_ONCE)
        twin = linear_twin(model, outputs, lines[part] / period, spectra[:, :, part], further=further)
        for number, damping in enumerate(dampings):
            velocity = twin.velocities(damping)
            rows = dict(zip([*outputs, *laws], twin.with_velocities(damping, velocity), strict=True))
            rows |= {f"{name}_velocity": row for name, row in zip(names, velocity, strict=True)}
            rows |= {f"{name}_force": c * row for name, c, row in zip(names, damping, velocity, strict=True)}
            result[number, :, :, part] = np.stack([rows[name] for name in channels], axis=1)
    return lines / period, result


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
        model, period, channels: see `twin_lines`.
        plates: wheel to displacement over one period [m].
        damping: damping constants c [N s/m]; (d,).
        samples: number of samples n of the result.
    """
    lines = twin_lines(model, [damping], [plates], period, channels, samples)[1][0, 0]
    whole = np.zeros((len(channels), samples // 2 + 1), dtype=np.complex128)
    # A line at k/T and its mirror image.
    whole[:, 1 : lines.shape[1] + 1] = lines * (samples / np.sqrt(2.0))
    return dict(zip(channels, np.fft.irfft(whole, samples, axis=1), strict=True))


def returning(signal: Signal) -> tuple[dict[str, Vector], float]:
    """Return the plates of a record, which begin at rest, continued to rest again [m], and the whole length [s]."""
    height = max(float(abs(displacement[-1])) for displacement in signal.displacement.values())
    fall, step = round(FALL_S * max(height / FALL_M, 1.0) ** 0.5 / signal.timestep), signal.timestep
    way = 0.5 * (1.0 + np.cos(np.pi * np.arange(1, fall + 1) / fall))
    count = signal.time.size
    total = fast_length(count + fall + round(PAUSE_S / step))
    plates = {}
    for wheel, displacement in signal.displacement.items():
        plates[wheel] = np.zeros(total)
        plates[wheel][: count + fall] = np.concatenate([displacement, displacement[-1] * way])
    return plates, total * step
