"""`python -m vehicle body participation`: contributions of the body modes to a response at a frequency."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.console import Console
from vehicle.commands.options import (
    damper_option,
    extra_output_options,
    message_options,
    setting_options,
    vehicle_options,
)
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.names import CORNERS
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.engines.linear.mode_participation import Participation

FILES = ("participation.csv", "attachments.csv", "participation.png")
LOWEST, HIGHEST, LINES = 1.0, 50.0, 600
"""Band of picture and table [Hz], and lines in it, 0.7 % apart: a tenth of the width of a peak with 3 % damping."""
SHOWN = 0.01
"""Share from which a line is printed by itself."""
CANCEL = 5.0
"""Sum of the sizes of the shares from which a response is called a small difference."""
UNIT = "m/s2/m"


@dataclass(frozen=True, kw_only=True, slots=True)
class ParticipationSettings(Settings):
    """Settings of the contributions of the body modes to a response.

    Attributes:
        damper: state of the dampers, "stuck" or "sliding".
    """

    car: CarChoice = part(CarChoice)
    response: str = setting(
        "acceleration channel of a point on the body; default: %(default)s", "seat_rail_acc_z", metavar="CHANNEL"
    )
    wheel: str | None = setting(
        "wheel whose plate moves, for example fr or front_right; default: the wheel on the shaker", metavar="NAME"
    )
    damper: str = "stuck"
    destination: Destination = part(Destination)
    at: float | None = setting(
        "frequency of the tables [Hz]; default: where the response between 1 and 50 Hz is largest",
        within="(0, inf)",
        type=float,
        metavar="HZ",
    )
    mode: int | None = setting(
        "number of the mode whose driving attachments are shown; default: the mode with the largest share",
        within="[1, inf)",
        type=int,
        metavar="N",
    )


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    asked = tasks.add_parser(
        "participation",
        help="rank the body modes by what they add to the vibration of a point, and the attachments that drive a mode",
    )
    setting_options(asked, ParticipationSettings, "response", "at")
    asked.former(
        "--place",
        "--place: no such option; name the acceleration with --response CHANNEL, for example --response "
        "seat_rail_acc_z",
    )
    setting_options(asked, ParticipationSettings, "wheel")
    damper_option(asked)
    setting_options(asked, ParticipationSettings, "mode")
    extra_output_options(asked, ", ".join(FILES))
    asked.add_argument("--json", action="store_true", help="print JSON")
    vehicle_options(asked)
    message_options(asked)


def run(settings: ParticipationSettings, console: Console) -> None:
    """Compute, write and print the contributions."""
    import numpy as np

    from vehicle.engines.linear.mode_participation import participation
    from vehicle.runs.car import Car

    vehicle, output = settings.car.load(), settings.destination.output
    wheel = CORNERS.get(settings.wheel or "", settings.wheel) or vehicle.shaker_wheel
    vehicle.require_wheels((wheel,))
    if output is not None:
        settings.destination.folder(output)
    car = Car(vehicle, folder=settings.car.folder)
    band = np.geomspace(LOWEST, HIGHEST, LINES)

    def of(lines: Any) -> Participation:
        stuck = settings.damper == "stuck"
        return participation(car.model, car.matrices, car.load_rows, settings.response, lines, stuck=stuck, wheel=wheel)

    over = of(band)
    at = round(float(band[np.abs(over.total).argmax()]), 2) if settings.at is None else settings.at
    result = of([at])
    modes = len(result.mode_frequency)
    if settings.mode is not None and not 1 <= settings.mode <= modes:
        raise ConfigurationError(f"--mode {settings.mode}: must be 1 to {modes}, the modes of this body")
    mode = int(result.shares[6:, 0].argmax()) if settings.mode is None else settings.mode - 1
    caption = f"{vehicle.name}: {settings.response} per displacement of plate {wheel}, dampers {settings.damper}"
    caption += f", tyres {vehicle.driving.words}"
    if output is not None:
        _write(output, settings, over, result, mode, caption)
    console.result(_numbers(settings, result, wheel), "\n".join(_report(result, mode, caption)))


def _named(result: Participation) -> list[str]:
    """Return the names of the contributions; names of modes include the frequency."""
    modes = [f"{f:.2f} Hz" for f in result.mode_frequency]
    return [*result.names[:6], *(f"{name}, {f}" for name, f in zip(result.names[6:], modes, strict=True))]


def _report(result: Participation, mode: int, caption: str) -> list[str]:
    """Return both tables as text, largest contributions first."""
    import numpy as np

    total, contributions = result.total[0], result.contributions[:, 0]
    lines = [
        f"{caption}, {result.frequency[0]:g} Hz: {abs(total):.4g} m/s² per m, "
        f"phase {np.degrees(np.angle(total)):.0f} deg",
        "share of the sum, counting only what acts in phase with it; a negative share reduces the sum",
        f"{'share':>9} {'(m/s²)/m':>10} {'to sum':>8}  contribution",
    ]
    names, shares = _named(result), result.shares[:, 0]
    small = [i for i in range(len(names)) if abs(shares[i]) < SHOWN]
    for i in sorted(set(range(len(names))) - set(small), key=lambda i: -abs(shares[i])):
        turned = np.degrees(np.angle(contributions[i] / total))
        lines.append(f"{_percent(shares[i])} {abs(contributions[i]):>10.4g} {turned:>+5.0f} deg  {names[i]}")
    if small:
        lines.append(f"{_percent(shares[small].sum())} {'':>10} {'':>9}  the other {len(small)} together")
    if np.abs(shares).sum() > CANCEL:
        lines.append("the point moves little at this frequency: large contributions nearly cancel each other")
    lines.append(f"what drives {names[6 + mode]}: share of each attachment in the force on this mode")
    drivers = result.attachment_shares[mode, :, 0]
    small = [i for i in range(len(drivers)) if abs(drivers[i]) < SHOWN]
    for i in sorted(set(range(len(drivers))) - set(small), key=lambda i: -abs(drivers[i])):
        lines.append(f"{_percent(drivers[i])}  {result.attachments[i]}")
    if small:
        lines.append(f"{_percent(drivers[small].sum())}  the other {len(small)} together")
    return lines


def _percent(share: float) -> str:
    return f"{100 * share:>+z7.1f} %"


def _numbers(settings: ParticipationSettings, result: Participation, wheel: str) -> dict[str, Any]:
    """Return both tables as plain numbers."""
    import numpy as np

    total, phase = result.total[0], np.degrees(np.angle(result.contributions[:, 0] / result.total[0]))
    frequencies = [None] * 6 + [float(frequency) for frequency in result.mode_frequency]
    return {
        "place": result.channel,
        "frequency_hz": float(result.frequency[0]),
        "wheel": wheel,
        "damper": settings.damper,
        "magnitude": abs(total),
        "phase_deg": float(np.degrees(np.angle(total))),
        "unit": UNIT,
        "contributions": [
            {
                "name": name,
                "frequency_hz": frequency,
                "share": float(result.shares[i, 0]),
                "magnitude": float(abs(result.contributions[i, 0])),
                "phase_to_sum_deg": float(phase[i]),
            }
            for i, (name, frequency) in enumerate(zip(result.names, frequencies, strict=True))
        ],
        "attachments": [
            {"mode": n + 1, "share": dict(zip(result.attachments, shares, strict=True))}
            for n, shares in enumerate(result.attachment_shares[:, :, 0].tolist())
        ],
    }


def _write(
    output: Path, settings: ParticipationSettings, over: Participation, result: Participation, mode: int, caption: str
) -> None:
    """Write both tables and the picture."""
    import numpy as np

    from vehicle.drawing.rendering.participation_plot import plot_participation
    from vehicle.engines.linear.mode_participation import in_phase
    from vehicle.runs.output.folder import output_folder, write_files
    from vehicle.signals.formats.csv_table import table_text, write_table

    at, keys = result.frequency[0], ["body_x", "body_y", "body_z", "body_rx", "body_ry", "body_rz"]
    keys += [f"mode_{n + 1}" for n in range(len(over.mode_frequency))]
    heads, columns = ["frequency [Hz]"], [over.frequency]
    for key, values, share in zip(
        ["total", *keys], [over.total, *over.contributions], [None, *over.shares], strict=True
    ):
        heads += [f"{key}_magnitude [{UNIT}]", f"{key}_phase [deg]"]
        columns += [np.abs(values), np.degrees(np.angle(values))]
        if share is not None:
            heads.append(f"{key}_share [%]")
            columns.append(100.0 * share)
    names = _named(over)
    comments = [caption, *(f"{key}: {name}" for key, name in zip(keys, names, strict=True))]
    rows = [["attachment", *(f"mode_{n + 1} [%]" for n in range(len(result.modal_forces)))]]
    for name, shares in zip(result.attachments, result.attachment_shares[:, :, 0].T, strict=True):
        rows.append([name, *(100.0 * shares)])
    attachments = table_text(rows, [f"{caption}, {at:g} Hz: share of each attachment in the force on each mode"])
    order = np.argsort(-np.abs(result.shares[:, 0]))
    drivers = result.attachment_shares[mode, :, 0]
    picture = partial(
        plot_participation,
        channel=settings.response,
        frequency=over.frequency,
        parts={names[i]: in_phase(over.contributions)[i] for i in order},
        at=at,
        shares={names[i]: float(result.shares[i, 0]) for i in order},
        driven=(names[6 + mode], dict(zip(result.attachments, drivers.tolist(), strict=True))),
        description=caption,
    )
    table = partial(write_table, cells=heads, columns=columns, comments=comments)
    with output_folder(output, force=settings.destination.force) as folder:
        write_files(folder, dict(zip(FILES, (table, attachments, picture), strict=True)))


SETTINGS = ParticipationSettings
