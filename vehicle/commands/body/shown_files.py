"""Files of `body show --output`: tables of modes, attachments and residuals, and a picture of the shapes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.digits import number

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement


def write_files(folder: Path, force: bool, model: Superelement, levels: Mapping[str, Any]) -> None:
    """Write the files.

    Args:
        folder: folder of the files; it is made.
        force: replace files of an earlier run.
        model: the body model.
        levels: normalised mode shapes at attachments and output points [-]: name to (modes, 3).
    """
    import numpy as np

    from vehicle.drawing.rendering.body_plot import MOST, plot_body
    from vehicle.runs.output.folder import output_folder, write_text, write_whole

    count = len(model.frequencies)
    modes = ["mode,frequency [Hz],damping ratio [-],name"]
    for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True)):
        modes.append(f'{i + 1},{frequency:.9g},{ratio:.6g},"{model.mode_names[i]}"')
    taking = ["# mode shape at each attachment and point, relative to the mean of the body: sqrt(m) Phi"]
    taking.append("attachment,axis" + "".join(f",mode_{number + 1} [-]" for number in range(count)))
    for name, values in levels.items():
        taking += [
            f"{name},{axis}," + ",".join(f"{value:.6g}" for value in values[:, i]) for i, axis in enumerate("xyz")
        ]
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    residuals = ["attachment" + "".join(f",{'xyz'[i]}{'xyz'[j]} [m/N]" for i, j in pairs)]
    residuals += [name + "".join(f",{values[i, j]:.6g}" for i, j in pairs) for name, values in model.residual.items()]
    # A place is a node of the picture where it is one of the model.
    shown = [index for index, node in enumerate(model.nodes) if node in levels]
    titles = [
        f"mode {i + 1}: {frequency:.2f} Hz, {number(100 * ratio, 2)} %"
        + ("" if model.mode_names[i] == f"mode {i + 1}" else f"\n{model.mode_names[i]}")
        for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True))
    ]
    more = f"; the first {MOST} of {count} modes" if count > MOST else ""
    caption = (
        f"grey: at rest; colour: displacement, each mode at its own scale; dots: attachments and output points{more}"
    )
    with output_folder(folder, force=force) as output:
        for name, lines in (("modes.csv", modes), ("attachments.csv", taking), ("residuals.csv", residuals)):
            write_text(output / name, "\n".join(lines) + "\n")
        if count:
            write_whole(
                output / "shapes.png",
                lambda file: plot_body(
                    file,
                    model.positions,
                    np.asarray(model.edges, dtype=int),
                    model.shapes,
                    titles,
                    np.array(shown, dtype=int),
                    f"Modes of the free body {model.name}",
                    caption,
                ),
            )
