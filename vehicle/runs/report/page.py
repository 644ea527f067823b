"""Page of the report: one HTML file with style, script, figures and values; it needs no network."""

import base64
import dataclasses
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from importlib import resources
from pathlib import Path

from markupsafe import Markup

from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.errors import ConfigurationError
from vehicle.runs.report import sections
from vehicle.runs.report.answer import answer, comfort_bands, explained
from vehicle.runs.report.base_run import base_run
from vehicle.runs.report.car_section import car_section
from vehicle.runs.report.comparison_section import MANY, curves_over_each_other, numbers_beside
from vehicle.runs.report.figures_section import figures_section
from vehicle.runs.report.film_section import film, film_part
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.levels_section import levels_section
from vehicle.runs.report.markup import templates
from vehicle.runs.report.modes_section import Modes, as_json, car_modes_of, modes_of, moving_modes
from vehicle.runs.report.run_input import car_title, references
from vehicle.runs.report.spectra_section import spectra
from vehicle.runs.report.verdict_section import verdict_section
from vehicle.runs.targets.target import Target
from vehicle.version import package_version

fill = templates(__file__)

Part = tuple[str, str, Markup]
"""Title, anchor and content of a section."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Trial:
    """Section in which the reader changes the car, which then runs in the page; a higher package makes it."""

    content: Markup  # content of the section
    numbers: str = ""  # numbers of its scripts as JSON; empty if the page cannot run this car on these plates
    script: str = ""  # script of the page
    worker: str = ""  # script that computes, in a thread of its own


def report_page(
    runs: Sequence[FinishedRun],
    progress: Callable[[float], None] | None = None,
    *,
    trial: Callable[[FinishedRun], Trial],
    targets: Mapping[str, Target] | None = None,
    measure: Sequence[str] = (),
    levels: str = "",
    pair: Path | None = None,
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of one run, or the comparison of several runs.

    Args:
        progress: called with the finished fraction.
        trial: makes the section for trials of a single run.
        targets: figures with their limits; the report then begins with the verdict on them.
        measure: further figures by their names in the catalogue.
        levels: motion of the plates for a chart of FRFs at every level; empty for none.
        pair: film of two runs side by side; none by default.
        author, project: names in the head of the page; may be empty.

    Returns:
        A whole HTML document.

    Raises:
        ConfigurationError: no run.
    """
    if not runs:
        raise ConfigurationError("report: the runs are missing; give at least one folder, for example runs/low")
    runs = told_apart(runs)
    done = progress or (lambda fraction: None)
    modes = [modes_of(run) for run in runs]
    done(0.1)
    tried = None
    if len(runs) == 1:
        tried = trial(runs[0])
        parts = _of_one(runs[0], modes[0], tried.content)
    else:
        parts = _of_several(runs, modes, lambda share: done(0.1 + 0.8 * share), pair)
    if levels:
        parts.insert(1, ("Every level", "levels", levels_section(levels, runs)))
    if measure:
        parts.insert(1, ("Figures", "figures", figures_section(measure, runs)))
    if targets is not None:
        parts.insert(0, ("Targets", "targets", verdict_section(targets, runs)))
    captions = "; ".join(dict.fromkeys(run.caption for run in runs))
    head = head_line(author, project)
    shown = _drawn(runs)
    data = as_json(car_modes_of([runs[k] for k in shown], [modes[k] for k in shown]))
    page = document(_title(runs), (captions, head), parts, modes=data, trial=tried)
    done(1.0)
    return page


def _title(runs: Sequence[FinishedRun]) -> str:
    """Return the title of a report: car and input, of several runs their names if these differ."""
    roads = [run.summary.input.road or {} for run in runs]
    titles = [car_title(run.car.vehicle.name, road, run.name) for run, road in zip(runs, roads, strict=True)]
    if len(runs) == 1:
        return titles[0]
    first, *others = (run.name for run in runs)
    against = "against" if set(references(runs)[1:]) == {0} else "and"
    compared = f"{' and '.join(others) if len(others) < 4 else f'{len(others)} runs'} {against} {first}"
    where = "the shaker" if not any(roads) else "the road" if all(roads) else "shaker and road"
    return f"{titles[0] if len(set(titles)) == 1 else f'Cars on {where}'}: {compared}"


def head_line(author: str = "", project: str = "") -> str:
    """Return project, author, date and version of the program, for the head of a page.

    Args:
        author, project: names; may be empty.
    """
    return ", ".join(filter(None, (project, author, date.today().isoformat(), package_version())))


def told_apart(runs: Sequence[FinishedRun]) -> list[FinishedRun]:
    """Return the runs with unique names: the parent folder is added to equal names, then a number."""
    names = [run.name for run in runs]
    longer = [
        f"{run.place.resolve().parent.name}/{run.name}" if names.count(run.name) > 1 else run.name for run in runs
    ]
    unique = [f"{name} ({i + 1})" if longer.count(name) > 1 else name for i, name in enumerate(longer)]
    return [dataclasses.replace(run, name=name) for run, name in zip(runs, unique, strict=True)]


def _of_one(run: FinishedRun, modes: Modes, trial_part: Markup) -> list[Part]:
    """Return the sections of the report of a single run, with the given section for trials."""
    base = base_run(run)
    single = answer([run], [modes]) + warned([run]) + sections.tiles(run)
    # Beside the table of reactions; on the first screen of a run without FRFs.
    bands = comfort_bands(run, modes, 6.2 if run.responses else PAGE_WIDTH)
    if not run.responses:
        single, bands = single + bands, Markup()
    changed = None if base is None else answer([base, run], [modes_of(base), modes]) + warned([base, run])
    parts = [
        ("Result", "result", explained(single if changed is None else changed)),
        ("This run", "alone", None if changed is None else single),
        ("Frequency responses", "responses", sections.responses(run, modes) if run.responses else None),
        ("Video", "film", film(run)),
        ("Car, signal, engine", "run", sections.what_was_run(run)),
        ("Try it", "trial", trial_part),
        ("Findings", "findings", sections.what_was_found(run, modes)),
        ("Notices", "notices", sections.notices(run)),
        ("Dampers", "dampers", sections.dampers(run)),
        ("Time histories", "time", sections.time_figure(run)),
        ("Comfort", "comfort", sections.comfort(run, bands)),
        ("Measured", "measured", sections.measured(run)),
        ("Modes", "modes", moving_modes([run], [modes])),
        ("Spectra", "spectra", spectra([run])),
        ("The car", "car", car_section(run.car)),
        ("All values", "tables", sections.tables(run)),
        ("How to repeat the run", "repeat", sections.repeating(run)),
    ]
    return [(title, anchor, content) for title, anchor, content in parts if content is not None]


def warned(runs: Sequence[FinishedRun]) -> Markup:
    """Return a line with the last warning of the solver, as on the error outside the valid range of the engine."""
    texts = {run.name: run.summary.solver.warnings[-1] for run in runs if run.summary.solver.warnings}
    if not texts:
        return Markup()
    name, others = next(iter(texts)), len(texts) - 1
    more = f" and {others} more {'run' if others == 1 else 'runs'}" if others else ""
    where = f" ({name}{more})" if len(runs) > 1 else ""
    return Markup("<p>Warning{}: {}.</p>").format(where, texts[name])


def _drawn(runs: Sequence[FinishedRun]) -> list[int]:
    """Return the indices of runs with pictures of their own: all; above `MANY` the first, the calmest, the loudest."""
    totals = [value.weighted for run in runs for value in list(run.comfort.values())[:1]]
    if len(runs) <= MANY:
        return list(range(len(runs)))
    ends = (totals.index(min(totals)), totals.index(max(totals))) if len(totals) == len(runs) else (1, len(runs) - 1)
    return sorted({0, *ends})


def _of_several(
    runs: Sequence[FinishedRun], modes: Sequence[Modes], done: Callable[[float], None], pair: Path | None
) -> list[Part]:
    """Return the sections of a comparison; what belongs to a single run is folded under its name."""
    shown = _drawn(runs)
    of_shown = [runs[k] for k in shown]
    few = fill("few_of_many", count=len(runs)) if len(shown) < len(runs) else Markup()
    # Runs on several inputs are compared on each of them.
    compared = shown if len({run.caption for run in runs}) == 1 else range(len(runs))
    verdict = answer([runs[k] for k in compared], [modes[k] for k in compared]) + warned(runs)
    parts = [
        ("Result", "result", few + explained(verdict)),
        *([("Video", "film", film_part(pair))] if pair is not None else []),
        ("Comparison of the runs", "comparison", numbers_beside(runs)),
        ("Frequency responses and spectra", "responses", curves_over_each_other(of_shown)),
        ("Time histories", "time", Markup().join(sections.time_figure(run, runs) for run in of_shown)),
        (f"The car of {runs[0].name}", "car", car_section(runs[0].car)),
        ("Modes", "modes", moving_modes(of_shown, [modes[k] for k in shown])),
    ]
    details = []
    for index, (run, car_modes) in enumerate(zip(runs, modes, strict=True)):
        # A car is shown once.
        drawn = index in shown
        new = drawn and all(run.car.vehicle != runs[k].car.vehicle for k in shown if k < index)
        of_run = (
            ("Pictures", None if drawn else fill("own_report", run=run.place)),
            ("Video", film(run, 1.0 / len(runs)) if drawn else None),
            ("Findings", sections.tiles(run) + sections.what_was_found(run, car_modes)),
            ("Notices", sections.notices(run)),
            ("Car, signal, engine", sections.what_was_run(run)),
            ("The car", car_section(run.car) if new and index else None),
            ("Frequency responses", sections.responses(run, car_modes) if run.responses and drawn else None),
            ("Dampers", sections.dampers(run)),
            ("Comfort", sections.comfort(run)),
            ("Measured", sections.measured(run)),
            ("All values", sections.tables(run)),
            ("How to repeat the run", sections.repeating(run)),
        )
        details.append((run.name, [(title, content) for title, content in of_run if content is not None]))
        done((index + 1) / len(runs))
    return [*parts, ("Each run", "runs", fill("each_run", runs=details))]


def document(
    title: str, subtitles: Sequence[str], parts: Sequence[Part], *, modes: str = "", trial: Trial | None = None
) -> str:
    """Return an HTML document; its security policy blocks external content and scripts.

    Args:
        subtitles: lines below the title.
        parts: title, anchor and content of each section.
        modes: points, lines and modes of the cars as JSON; empty for a page without moving pictures.
        trial: section for trials, whose scripts the page gets; None for a page without it.
    """
    run_scripts = [_file("print.js"), _file("wireframe.js")] if modes else []
    if any(anchor == "modes" for _, anchor, _ in parts):
        run_scripts.append(_file("modes.js"))
    allowed, tried = "", trial if trial and trial.numbers else Trial(content=Markup())
    if tried.numbers:
        run_scripts.append(tried.script)
        # Its worker is a script from the page itself, and runs a module of WebAssembly.
        allowed = " 'wasm-unsafe-eval'; worker-src blob:"
    digests = (base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in run_scripts)
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests) or "'none'"
    return fill(
        "page",
        title=title,
        subtitles=subtitles,
        parts=parts,
        policy="default-src 'none'; img-src data:; media-src data:; style-src 'unsafe-inline'; "
        f"script-src {hashes}{allowed}",
        style=Markup(_file("page.css")),
        modes=Markup(modes),
        numbers=Markup(tried.numbers),
        worker=Markup(tried.worker),
        scripts=[Markup(text) for text in run_scripts],
    )


def _file(name: str) -> str:
    """Return the text of a file of this package."""
    return resources.files("vehicle.runs.report").joinpath(name).read_text(encoding="utf-8")
