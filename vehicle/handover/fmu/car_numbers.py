"""Numbers of a car for the runtime of its FMU: those of the reduced engine at a fixed time step, as bytes.

The layout is that of `Car` in runtime/car.h, the order of the arrays that of runtime/car_data.c. Pole pairs and real
poles are filled up with zeros to multiples of LANES.
"""

from __future__ import annotations

import dataclasses
import hashlib
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.car_table import damper_nodes
from vehicle.engines.reduced.feedback import sensor_outputs
from vehicle.engines.reduced.pole_model import Outputs
from vehicle.engines.reduced.step_factors import CarFactors, car_factors
from vehicle.errors import ConfigurationError
from vehicle.handover.fmu.output_rows import Output, OutputRows, Watched, car_outputs, watched_outputs
from vehicle.model.laws.control_laws import NUMBERS, in_steps, pack
from vehicle.model.laws.curve import BEYOND
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.semi_active_damper import FMU

if TYPE_CHECKING:
    from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

MAGIC, LANES, TOKEN, NAME, NOTICE = b"VEHFMU03", 4, 40, 64, 160
"""First bytes of the file; multiple of the poles; sizes of texts. As in runtime/car.h."""

FRICTION_CODES = {"coulomb": 0, "stribeck": 1, "presliding": 2}
"""Friction laws in the C runtime, with their codes there."""

DAMPER_FIELDS = (
    *("viscous", "viscous_law", "degressive_viscous", "degressive_velocity", "velocity", "force", "gas_force", "stop"),
    *("control", "friction_law", "coulomb_friction", "smoothing", "slip_velocity"),
    *("stribeck_friction", "stribeck_velocity", "stribeck_exponent"),
    *("presliding_stiffness", "presliding_force", "presliding_slope"),
)
"""Parameters of a damper that the numbers of the runtime contain, or that describe only its evaluation; values of
others must be the default."""

PARAMETERS = {
    "coulomb_friction": "N",
    "static_friction": "N",
    "stribeck_velocity": "m/s",
    "stribeck_exponent": "",
    "curve_scale": "",
    "control": "",
}
"""Tunable parameters of a damper, with units, in the order of runtime/car.h."""

COMMANDS = {"force": "N", "coefficient": "N s/m"}
"""Commands of a damper, with units."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarNumbers:
    """Numbers of a car for the runtime.

    Attributes:
        content: content of resources/car.bin.
        token: text that ties model description and resources together.
        step: internal time step [s].
        rolling: True for rolling tyres.
        plates, dampers: names of the wheels with plates and of the dampers.
        outputs: the outputs.
        parameters: first values of the parameters; (dampers, `PARAMETERS`).
        lengths: number of values of each array of the file, in its order.
    """

    content: bytes
    token: str
    step: float
    rolling: bool
    plates: tuple[str, ...]
    dampers: tuple[str, ...]
    outputs: tuple[Output, ...]
    parameters: Vector
    lengths: dict[str, int]


def car_numbers(car: Car, channels: Sequence[str], step: float) -> CarNumbers:
    """Return the numbers of a car with all its outputs of channels, sensors and notices.

    Args:
        car: the car.
        channels: names of the recorded channels among the outputs; plate displacements, which are inputs, are left
            out.
        step: internal time step [s].

    Raises:
        ConfigurationError: see `numbers_with`.
    """
    return numbers_with(car, step, car_outputs(car, channels), watched_outputs(car))


def numbers_with(car: Car, step: float, read: tuple[Sequence[Output], OutputRows], watched: Watched) -> CarNumbers:
    """Return the numbers of a car with given outputs.

    Args:
        car: the car.
        step: internal time step [s].
        read: the outputs and their rows.
        watched: quantities that must stay within limits.

    Raises:
        ConfigurationError: the C runtime lacks a friction law, or rubber friction, or the car has no damper.
    """
    composition = car.vehicle.composition.dampers
    laws = [damper.law for damper in composition]
    if not laws:
        raise ConfigurationError(
            f"{car.vehicle.name}: has no damper; an FMU and the sliders of a report need "
            "a car with dampers at its wheels"
        )
    for damper in composition:
        _require_known(damper.name, damper.law)
    for law in car.matrices.laws:
        if law.friction:
            raise ConfigurationError(
                f"{law.name}: has rubber friction (friction_force), which an FMU and the sliders of a report do not "
                "contain; set friction_force to 0"
            )
    model, wheels = car.poles.without_laws(), car.poles.matrices.system.inputs
    columns, rolling = list(range(len(wheels))), car.poles.slope.shape[1] > 0
    (factors,) = car_factors([model], step, columns, exact=True, present_load=rolling)
    sensors = sensor_outputs(model, laws, columns, car.static.tyre_load if rolling else None)
    controlled = {index: pack(law.controlled) for index, law in enumerate(laws) if law.controlled}
    controls = in_steps(np.reshape(list(controlled.values()), (-1, NUMBERS)), step)
    outputs, rows = read
    nodes, parameters = _law_nodes(laws), np.array([_parameters(law) for law in laws])
    poles = ("pair_change", "pair_inputs", "pair_sums", "real_change", "real_inputs", "real_sums")
    gains = dict(zip(("slip", "gain", "ramp"), factors.gains, strict=True))
    arrays = {
        **dict(zip(poles, _pole_arrays(factors, sensors), strict=True)),
        "slip": gains["slip"],
        "level": factors.levels,
        "gain": gains["gain"],
        "ramp": gains["ramp"],
        "law": nodes,
        "damper": _damper_numbers(laws, list(controlled)),
        "parameter": parameters,
        "control": np.array([list(record)[:NUMBERS] for record in controls]).reshape(-1, NUMBERS),
        "spring": factors.sliders.stiffness,
        "share": factors.sliders.limit,
        "owner": factors.sliders.dampers,
        "direct": factors.weights_of(sensors)[:, factors.states :],
        "sensor_start": np.hstack([sensors.velocity, factors.weights_of(sensors)[:, -len(wheels) :]]),
        "start": _start(factors),
        "output_kind": np.array([(output.kind, output.damper) for output in outputs], dtype=float),
        "fixed": np.concatenate([rows.fixed, watched.rows.fixed]),
        "rows": _weights(factors, rows.outputs),
        "watched_rows": _weights(factors, watched.rows.outputs),
        "by_force": np.vstack([rows.force, watched.rows.force]),
        "by_tyre": np.vstack([rows.slope, watched.rows.slope]),
        "limit": watched.limits,
    }
    sizes = (
        *(LANES * -(-count // LANES) for count in (factors.pairs, factors.reals)),
        len(laws),
        len(wheels),
        len(wheels) if rolling else 0,
        factors.plate_inputs,
        len(controls),
        1 + int(np.max(controls["lag"], initial=0.0)),
        nodes.shape[1],
        factors.iterations,
        len(outputs),
        int(any(law.friction_law == "stribeck" for law in laws)),
        *factors.sliders.stiffness.shape,
        len(watched.notices),
    )
    names = [*wheels, *(damper.name for damper in composition)]
    body = b"".join(
        [
            struct.pack("<d", step),
            struct.pack(f"<{len(sizes)}q", *sizes),
            *(np.ascontiguousarray(array, dtype="<f8").tobytes() for array in arrays.values()),
            *(_text(name, NAME) for name in names),
            *(_text(notice, NOTICE) for notice in watched.notices),
        ]
    )
    described = "\n".join([body.hex(), *(f"{output.name} {output.unit}" for output in outputs)])
    token = "{" + hashlib.sha256(described.encode()).hexdigest()[:32] + "}"
    return CarNumbers(
        content=MAGIC + _text(token, TOKEN) + body,
        token=token,
        step=step,
        rolling=rolling,
        plates=tuple(wheels),
        dampers=tuple(damper.name for damper in composition),
        outputs=tuple(outputs),
        parameters=parameters,
        lengths={name: int(np.size(array)) for name, array in arrays.items()},
    )


def _require_known(name: str, law: Damper) -> None:
    """Refuse a damper with a law that the C runtime lacks.

    Args:
        name: name of the damper.
        law: its laws.

    Raises:
        ConfigurationError: the law of friction, or a further parameter that is set, is not in the C runtime.
    """
    if law.friction_law not in FRICTION_CODES:
        raise ConfigurationError(
            f"{name}.friction_law: an FMU can have {', '.join(FRICTION_CODES)}, not {law.friction_law!r}; set one of "
            "them"
        )
    if law.controlled is not None and law.controlled.law == FMU:
        raise ConfigurationError(
            f"{name}.control.law: found {FMU!r}; an FMU of a car does not contain another FMU: set law = skyhook, and "
            f"in the other simulator {name}_control = 0 and {name}_coefficient_command from the controller"
        )
    for entry in dataclasses.fields(law):
        value = getattr(law, entry.name)
        if entry.name not in DAMPER_FIELDS and value != entry.default:
            raise ConfigurationError(
                f"{name}.{entry.name}: found {value!r}; an FMU and the sliders of a report do not contain this "
                "law of a damper: leave it out"
            )


def _text(text: str, size: int) -> bytes:
    """Return a text in a field of a given size [byte], cut and ended with zeros."""
    return text.encode()[: size - 1].ljust(size, b"\0")


def _split(rows: Complex, pairs: int) -> Vector:
    """Return rows (k, p + q) as real and imaginary parts of the pairs, then the real poles, each filled up with zeros.

    Args:
        rows: rows over the poles.
        pairs: p.
    """
    parts = (rows[:, :pairs].real, rows[:, :pairs].imag, rows[:, pairs:].real)
    return np.hstack([np.pad(part, ((0, 0), (0, -part.shape[1] % LANES))) for part in parts])


def _pole_arrays(factors: CarFactors, sensors: Outputs) -> list[Vector]:
    """Return the arrays of pole pairs and of real poles: change, inputs, sums; see `CarFactors.step`."""
    strokes = factors.strokes.reshape(-1, factors.slip.shape[1])
    sums = np.concatenate([factors.slip, strokes, sensors.poles])[:, factors.integrated].conj()
    arrays = [_split(array, factors.pairs) for array in (factors.step.T[:1], factors.step.T[1:], sums)]
    end = 2 * (LANES * -(-factors.pairs // LANES))
    return [*(array[:, :end] for array in arrays), *(array[:, end:] for array in arrays)]


def _start(factors: CarFactors) -> Vector:
    """Return the states of a car at rest in equilibrium as rows over z' and z; (2 m, states).

    The states are differences from the static values on the plates, so they do not depend on z.
    """
    m = len(factors.columns)
    moving = -factors.direct[factors.integrated, -2 * m : -m].T
    return _split(np.vstack([moving, np.zeros_like(moving)]), factors.pairs)


def _weights(factors: CarFactors, outputs: Outputs) -> Vector:
    """Return the weights of linear outputs over states, mean forces, slopes, z' and z."""
    direct = factors.weights_of(outputs)[:, factors.states :]
    return np.hstack([_split(outputs.poles[:, factors.integrated].conj(), factors.pairs), direct])


def _law_nodes(laws: Sequence[Damper]) -> Vector:
    """Compute the nodes of all damper laws with their outer segments; (d, nodes, 3), see `damper_nodes`."""
    nodes_of_laws = []
    for law in laws:
        curve, nodes = damper_curve(law), damper_nodes(law)[2]
        for end, at in ((-BEYOND, 0), (BEYOND, len(nodes))):
            if end not in nodes[:, 0]:
                # The segments must go on outside: a scale of the curve, or a command, acts on them too.
                friction = float(nodes[0 if end < 0.0 else -1, 2])
                excess = float(curve.force(end)) - float(curve.force(0.0)) - curve.least_slope * end
                nodes = np.insert(nodes, min(at, len(nodes)), [end, 0.5 * excess, friction], axis=0)
        nodes_of_laws.append(nodes[np.argsort(nodes[:, 0])])
    longest = max(len(nodes) for nodes in nodes_of_laws)
    return np.array([nodes[np.minimum(np.arange(longest), len(nodes) - 1)] for nodes in nodes_of_laws])


def _damper_numbers(laws: Sequence[Damper], controlled: Sequence[int]) -> Vector:
    """Return friction law, velocity of full friction, D, force at rest and control (-1: none) of each damper."""
    numbers = []
    for index, law in enumerate(laws):
        record, full, _ = damper_nodes(law)
        control = list(controlled).index(index) if index in controlled else -1
        code = FRICTION_CODES[law.friction_law]
        numbers.append([code, full, record["viscous_damping"], record["rest_force"], control])
    return np.array(numbers, dtype=float)


def _parameters(law: Damper) -> list[float]:
    """Return the first values of `PARAMETERS`."""
    record: Any = damper_nodes(law)[0]
    names = ("friction_limit", "static_limit", "stribeck_velocity", "stribeck_exponent")
    return [*(float(record[name]) for name in names), 1.0, 1.0 if law.controlled else 0.0]
