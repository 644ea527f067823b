"""Force of a damper law under measured motions, with its derivatives: `vehicle.studies.dampers.damper_law`.

The motions of several tests are computed in one pass (`joined`); each begins with its measured force.

Without a series stiffness the force is a function of velocity and displacement; the force of a Jenkins element follows
from its displacement after the last slip. With a series stiffness K the deflection s is solved for at each sample,

    K s = F_c(v - s') + sum of clamp(t_i + k_i du, l_i) + k_g (x - s) + F_0,   s' = a_0 s + a_1 s_1 + a_2 s_2,

(with a gap g in series K (s -+ g/2) beyond +-g/2 and 0 inside, and Coulomb friction is added)

with the backward difference of second order for steps h, h_1 (r = h/h_1): a_0 = (1 + 2 r)/((1 + r) h),
a_1 = -(1 + r)/h, a_2 = r^2/((1 + r) h). It is stable for any K. The right side falls with s, so the solution is unique.
The derivatives of s over the parameters solve the linearised equations of all samples at once (a triangular band).
"""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Mask, Vector
from vehicle.core.library import core
from vehicle.core.records import packed
from vehicle.studies.dampers.damper_law import EXPONENT, SOFT_STEP, STEP, DamperLaw, DamperValues, values_of
from vehicle.studies.dampers.damper_setting import Setting

Counts = npt.NDArray[np.intp]

_CHANNELS = ("time", "displacement", "velocity")

FASTEST_GROWTH = 2.0
"""Maximum ratio of two successive steps for the difference of second order, which is stable up to 2.4."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of a damper."""

    time: Vector  # time, displacement, velocity: [s], [m], [m/s]; (n,)
    displacement: Vector
    velocity: Vector
    first_force: float  # force at the first sample [N]
    # steps of the solution of a series stiffness from each sample to the next, on the cubic through displacements and
    # velocities; (n - 1,), or 1 for all
    parts: Counts | int = 1
    setting: Setting | None = None  # condition that changes during the test
    joined: tuple[Motion, ...] = ()  # motions of several tests, one after the other; see `joined`

    @property
    def tests(self) -> tuple[Motion, ...]:
        """Return the motions of the tests."""
        return self.joined or (self,)

    @cached_property
    def firsts(self) -> Counts:
        """Return the number of the first sample of each test; (tests,)."""
        return np.cumsum([0, *(test.time.size for test in self.tests[:-1])])

    @cached_property
    def starts(self) -> Counts:
        """Return the number of the first sample of the test of each sample; (n,)."""
        return np.repeat(self.firsts, [test.time.size for test in self.tests])

    @cached_property
    def refined(self) -> tuple[Motion, Counts]:
        """Return the motion with its parts as samples, and the numbers of the samples of this motion among them."""
        if self.joined:
            fine = joined([test.refined[0] for test in self.joined])
            shifted = [first + test.refined[1] for first, test in zip(fine.firsts, self.joined, strict=True)]
            return fine, np.concatenate(shifted)
        rows = np.concatenate([[0], np.cumsum(np.broadcast_to(self.parts, self.time.size - 1))])
        time = np.interp(np.arange(rows[-1] + 1), rows, self.time)
        cubic = scipy.interpolate.CubicHermiteSpline(self.time, self.displacement, self.velocity)
        return Motion(time, cubic(time), cubic.derivative()(time), self.first_force), rows

    @cached_property
    def rates(self) -> Vector:
        """Return a_0, a_1 and a_2 of the backward difference at each sample [1/s]; (3, n), zeros at the first."""
        if self.joined:
            return np.concatenate([test.rates for test in self.joined], axis=1)
        steps = np.diff(self.time, prepend=self.time[0] - 1.0)
        ratio = steps / np.concatenate([[np.inf, np.inf], steps[1:-1]])
        ratio[ratio > FASTEST_GROWTH] = 0.0
        ratio[0] = 0.0
        weights = np.stack([(1.0 + 2.0 * ratio) / (1.0 + ratio), -(1.0 + ratio), ratio**2 / (1.0 + ratio)]) / steps
        weights[:, 0] = 0.0
        return np.asarray(weights)


def joined(motions: Sequence[Motion]) -> Motion:
    """Return the motions of several tests as one, for `force_and_slopes`."""
    time, x, v = (np.concatenate([getattr(motion, name) for motion in motions]) for name in _CHANNELS)
    return Motion(time, x, v, motions[0].first_force, joined=tuple(motions))


def force_and_slopes(law: DamperLaw, parameters: Vector, motion: Motion) -> tuple[Vector, Vector]:
    """Return the force [N], (n,), and its derivatives over the parameters, (n, p).

    Args:
        parameters: in the order of `law.parameters`, SI units; with widths and excess, see `plain_parameters`; (p,).
    """
    if law.setting:
        return _mixed(law, parameters, motion)
    values = values_of(law, parameters)
    if not law.series:
        return _rigid(law, values, motion)
    fine, rows = motion.refined
    deflection, inner, sticking = _march(values, fine)
    columns = _slopes(law, values, fine, deflection, inner, sticking)
    force, columns = values.series * _engaged(values, deflection[rows]), columns[rows]
    if law.gap:
        turned = np.clip(motion.velocity / SOFT_STEP, -1.0, 1.0)
        force += values.outer_friction * turned
        columns[:, list(law.parameters).index("outer_friction")] = turned
    return force, columns


def _engaged(values: DamperValues, deflection: Vector) -> Vector:
    """Return the deflection beyond the gap of both directions [m]; (n,)."""
    return np.asarray(deflection - np.clip(deflection, -0.5 * values.gap, 0.5 * values.gap))


def _mixed(law: DamperLaw, parameters: Vector, motion: Motion) -> tuple[Vector, Vector]:
    """Return force and derivatives of a soft and a firm law with a changing setting, see `damper_setting`."""
    names, numbers = list(law.parameters), dict(zip(law.parameters, parameters.tolist(), strict=True))
    at = numbers["lag"], numbers.get("delay", 0.0), numbers.get("saturation", 1.0)
    settings = [test.setting for test in motion.tests]
    theta, *slopes = np.concatenate([setting.shares(*at) for setting in settings if setting is not None], axis=1)
    columns = np.zeros((theta.size, len(names)))
    forces = []
    for share, half in zip((1.0 - theta, theta), law.halves, strict=True):
        force, of_half = force_and_slopes(law.passive, parameters[half], motion)
        forces.append(force)
        columns[:, half] += share[:, None] * of_half
    change = forces[1] - forces[0]
    for name, slope in zip(("lag", "delay", "saturation"), slopes, strict=True):
        if name in names:
            columns[:, names.index(name)] = change * slope
    return forces[0] + theta * change, columns


def _curve(values: DamperValues, step_width: float) -> tuple[list[float], list[float], list[float]]:
    """Return breakpoints, slopes and offsets of the segments of F_c with Coulomb friction, from bump to rebound.

    Friction reaches its limit at a velocity of `step_width` [m/s].
    """
    step = values.friction[1] / step_width
    knots: list[float] = []
    forces: list[float] = []
    ends = []
    for sign, slopes, widths in zip((1.0, -1.0), values.slopes.tolist(), values.widths.tolist(), strict=True):
        at = force = 0.0
        points = []
        for slope, width in zip(slopes, widths, strict=False):
            at, force = at + width, force + slope * width
            points.append((sign * at, sign * (force + step * min(at, step_width))))
        if step:
            inside = sum(c * max(min(step_width - a, w), 0.0) for c, a, w in zip(
                slopes, [0.0, *itertools.accumulate(widths)], [*widths, np.inf], strict=True))  # fmt: skip
            points = sorted(
                [*points, (sign * step_width, sign * (inside + step * step_width))], key=lambda each: abs(each[0])
            )
        ends.append(slopes[-1] + (step if not points else 0.0))
        knots = [*knots, *(v for v, _ in points)] if sign > 0.0 else [*(v for v, _ in points[::-1]), 0.0, *knots]
        forces = [*forces, *(f for _, f in points)] if sign > 0.0 else [*(f for _, f in points[::-1]), 0.0, *forces]
    inner = [(after - before) / (right - left) for (left, right), (before, after) in zip(
        itertools.pairwise(knots), itertools.pairwise(forces), strict=True)]  # fmt: skip
    slopes = [ends[1], *inner, ends[0]]
    anchors = [0, *range(len(knots))]
    return knots, slopes, [forces[i] - c * knots[i] for i, c in zip(anchors, slopes, strict=True)]


def _march(values: DamperValues, motion: Motion) -> tuple[Vector, Vector, Mask]:
    """Return deflection s [m], inner velocity w [m/s], (n,), and True where a Jenkins element sticks, (m, n)."""
    knots, slopes, offsets = map(np.array, _curve(values, STEP))
    samples, elements = motion.time.size, values.limit.size
    sliding, at_rest, critical = values.friction
    deflection, inner = np.empty(samples), np.empty(samples)
    sticking = np.empty((samples, elements), dtype=np.uint8)
    first = 0
    for test in motion.tests:
        rows = slice(first, first + test.time.size)
        first = rows.stop
        rig = packed(
            "DamperRig",
            {
                "displacement": np.ascontiguousarray(test.displacement),
                "velocity": np.ascontiguousarray(test.velocity), "rates": test.rates,
                "knots": knots, "slopes": slopes, "offsets": offsets,
                "stiffness": values.stiffness, "limit": values.limit, "forces": np.zeros(elements),
                "spring": values.series, "gas": values.gas_stiffness, "offset": values.offset,
                "drop": at_rest - sliding, "critical": critical, "half": 0.5 * values.gap,
                "first": test.first_force - values.outer_friction * np.sign(test.velocity[0]),
                "deflection": deflection[rows], "inner": inner[rows], "sticking": sticking[rows],
            },
        )  # fmt: skip
        core().core_damper_rig(ctypes.c_void_p(rig.address))
    return deflection, inner, np.ascontiguousarray(sticking.T != 0)


def _curve_columns(law: DamperLaw, values: DamperValues, velocity: Vector, step_width: float) -> tuple[Vector, Vector]:
    """Return dF_c/dv, (n,), and the derivatives of F_c over the parameters of the curve, (n, c)."""
    size, slope, columns = np.abs(velocity), np.zeros(velocity.size), []
    for number, (slopes, widths) in enumerate(zip(values.slopes, values.widths, strict=True)):
        on_side = velocity > 0.0 if number == 0 else velocity <= 0.0
        ends = np.cumsum(widths)
        starts = np.concatenate([[0.0], ends])
        segment = np.searchsorted(ends, size)
        sign = np.where(on_side, np.sign(velocity), 0.0)
        slope = np.where(on_side, slopes[segment], slope)
        covered = [np.clip(size - start, 0.0, width) for start, width in zip(starts, [*widths, np.inf], strict=True)]
        beyond = [(size > end) * (slopes[j] - slopes[j + 1]) for j, end in enumerate(ends)]
        shifted = list(np.cumsum(beyond[::-1], axis=0)[::-1]) if beyond else []
        columns.append(np.column_stack([sign * column for column in [*covered, *shifted]]))
    step = np.abs(velocity) < step_width
    curve = np.concatenate(columns, axis=1) if law.own_sides else columns[0] + columns[1]
    sliding, at_rest, critical = values.friction
    slope = slope + step * at_rest / step_width
    stuck, sign = np.clip(velocity / step_width, -1.0, 1.0), np.sign(velocity)
    if law.friction == "coulomb":
        curve = np.column_stack([curve, stuck])
    if law.friction == "stribeck":
        ratio = (size / critical) ** EXPONENT
        weight = np.exp(-ratio)
        change = (at_rest - sliding) * weight * EXPONENT * ratio
        slope = slope - change / np.maximum(size, 1e-30)
        curve = np.column_stack([curve, stuck, stuck - sign * (1.0 - weight), sign * change / critical])
    return slope, curve


def steady_force(law: DamperLaw, parameters: Vector, velocity: Vector) -> tuple[Vector, Vector]:
    """Return the force of curve and sliding friction at constant velocities [N], (n,), and its derivatives, (n, p)."""
    values, names = values_of(law, parameters), list(law.parameters)
    _, curve = _curve_columns(law, values, velocity, STEP)
    columns = np.zeros((velocity.size, len(names)))
    columns[:, 1 : 1 + curve.shape[1]] = curve
    steps = [at for at, name in enumerate(names) if name.startswith("slider_limit_") or name == "outer_friction"]
    columns[:, steps] = np.sign(velocity)[:, None]
    sliding = float(np.sum(values.limit)) + values.outer_friction
    return _curve_force(values, velocity, STEP) + np.sign(velocity) * sliding, columns


def _curve_force(values: DamperValues, velocity: Vector, step_width: float) -> Vector:
    """Return F_c with Coulomb or Stribeck friction [N] at velocities [m/s]; (n,)."""
    knots, slopes, offsets = _curve(values, step_width)
    segment = np.searchsorted(knots, velocity)
    force = np.array(slopes)[segment] * velocity + np.array(offsets)[segment]
    sliding, at_rest, critical = values.friction
    if at_rest != sliding:
        force -= np.sign(velocity) * (at_rest - sliding) * -np.expm1(-((np.abs(velocity) / critical) ** EXPONENT))
    return np.asarray(force)


def _rigid(law: DamperLaw, values: DamperValues, motion: Motion) -> tuple[Vector, Vector]:
    """Return force and derivatives without a series stiffness."""
    x, v = motion.displacement, motion.velocity
    _, curve = _curve_columns(law, values, v, SOFT_STEP)
    force = _curve_force(values, v, SOFT_STEP) + values.gas_stiffness * x + values.offset
    columns = [-np.ones((x.size, 1)), curve]
    for k, limit in zip(values.stiffness, values.limit, strict=True):
        path = np.concatenate([_slider_force(test.displacement, float(k), float(limit)) for test in motion.tests])
        slips = np.maximum.accumulate(np.where(np.abs(path) >= limit, np.arange(x.size), -1))
        begun = slips >= motion.starts
        start = np.where(begun, x[np.maximum(slips, 0)], x[motion.starts])
        strained = np.where(begun, np.sign(path[np.maximum(slips, 0)]), 0.0) + (x - start) * k / limit
        columns.append(np.column_stack([strained, -(x - start) * k**2 / limit]))
        force = force + path
    columns += [x[:, None]] if law.gas_stiffness else []
    return force, np.concatenate(columns, axis=1)


def _slider_force(x: Vector, stiffness: float, limit: float) -> Vector:
    """Return the force of a Jenkins element [N] over displacements [m], from rest at the first; (n,)."""
    path, force = np.ascontiguousarray(x), np.empty(x.size)
    core().core_slider(
        ctypes.c_int64(x.size), path.ctypes.data_as(ctypes.c_void_p), ctypes.c_double(stiffness),
        ctypes.c_double(limit), force.ctypes.data_as(ctypes.c_void_p),
    )  # fmt: skip
    return force


def _slopes(law: DamperLaw, values: DamperValues, motion: Motion, s: Vector, w: Vector, sticking: Mask) -> Vector:
    """Return the derivatives of K s over the parameters, (n, p), from the linearised equations.

    Unknown in the order s, t_1 ... t_m of each sample; row of s: (K + k_g) ds - dt_1 ... - c dw = explicit derivatives
    of the right side - s dK, with dw = -(a_0 ds + a_1 ds_1 + a_2 ds_2); rows of t_i: dt_i + k_i ds - dt_i1 - k_i ds_1 =
    du dk_i where it sticks, dt_i = +-dl_i where it slips; k_i is the limit l_i over the stroke. The rows of
    a sample are summed in its first row, which gives a triangular band: a sample follows from earlier samples. With a
    gap g, s in K s is the deflection e beyond it: de = ds -+ dg/2, and zero in the gap.
    """
    n, m = s.size, len(values.stiffness)
    rates, near, far = motion.rates
    names = list(law.parameters)
    u = motion.displacement - s
    du = np.diff(u, prepend=u[0])
    slope, curve = _curve_columns(law, values, w, STEP)
    sticking = sticking.copy()
    sticking[:, motion.firsts] = False  # t is zero there
    size = m + 1
    # Both arrays are transposed: LAPACK stores columns in sequence.
    right = np.zeros((len(names), n, size))
    right[0, :, 0] = -1.0
    right[1 : 1 + curve.shape[1], :, 0] = curve.T
    engaged = _engaged(values, s)
    spring = np.where((engaged == 0.0) & law.gap, 0.0, values.series)
    gap = 0.5 * spring * np.sign(s)
    right[names.index("series_stiffness"), :, 0] = -engaged
    if law.gap:
        right[names.index("gap"), :, 0] = gap
    if law.gas_stiffness:
        right[names.index("gas_stiffness"), :, 0] = u
    band = np.zeros((n, size, 2 * size + 1))

    def entry(row: int, column: int, lag: int, value: npt.ArrayLike) -> None:
        """Set the entries of all samples in a row of the equations, for an unknown `lag` samples earlier."""
        band[: n - lag, column, row - column + lag * size] = np.broadcast_to(value, n)[lag:]

    held = sticking * values.stiffness[:, None]
    total = np.sum(held, axis=0)
    entry(0, 0, 0, spring + values.gas_stiffness + slope * rates + total)
    entry(0, 0, 1, slope * near - total)
    entry(0, 0, 2, slope * far)
    for i, stuck in enumerate(sticking):
        at, limit = names.index(f"slider_limit_{i + 1}"), values.limit[i]
        right[at, :, i + 1] = np.where(stuck, du * held[i] / limit, np.sign(du))
        right[at + 1, :, i + 1] = -du * held[i] ** 2 / limit
        right[:, :, 0] += right[:, :, i + 1]
        entry(i + 1, i + 1, 0, 1.0)
        entry(i + 1, 0, 0, held[i])
        entry(i + 1, 0, 1, -held[i])
        entry(i + 1, i + 1, 1, -1.0 * stuck)
        entry(0, i + 1, 1, -1.0 * stuck)
    # First sample: s is the measured force over K, t is zero.
    first = motion.firsts
    band[first, 0, 0] = values.series
    right[:, first] = 0.0
    right[names.index("series_stiffness"), first, 0] = -engaged[first]
    if law.gap:
        right[names.index("gap"), first, 0] = 0.5 * values.series * np.sign(s[first])
    solution, _ = scipy.linalg.lapack.dtbtrs(
        band.reshape(n * size, -1).T, right.reshape(len(names), -1).T, uplo="L", overwrite_b=True
    )
    columns = spring[:, None] * solution[::size]
    columns[:, names.index("series_stiffness")] += engaged
    if law.gap:
        columns[:, names.index("gap")] -= gap
    return np.asarray(columns)
