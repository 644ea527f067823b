"""The publications (thesis of Bommer and two papers): title, studies, sections, and the places of rows."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

Number = tuple[str, ...]
"""Parts of the number of a figure, a table or a section: ("3", "17")."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Section:
    """Section of a publication."""

    number: str  # printed number
    title: str  # printed title
    first: str | None = None  # number of the first figure; None for a section without figures


@dataclass(frozen=True, kw_only=True, slots=True)
class Source:
    """Publication, with the studies that compute its results."""

    key: str  # prefix of the anchors of the page
    short: str  # name in tables
    title: str  # full reference
    studies: tuple[str, ...]  # names of the studies, in the order of the table
    sections: tuple[Section, ...] = ()  # sections in order; empty for a publication with figures numbered consecutively
    tables: Mapping[str, str] = field(default_factory=dict)  # number of a table to number of its section


THESIS = Source(
    key="bommer",
    short="thesis of Bommer, 2006",
    title="Bommer, *A Nonlinear Vehicle Model for Comfort Analysis*, master's thesis OCT 2006.43, TU Eindhoven, 2006",
    studies=("levels", "inertia", "bump", "stribeck", "comfort_sensitivity", "quarter_car", "source_choice"),
    sections=(
        Section(number="2.1", title="Experimental study on different roads", first="2.1"),
        Section(number="2.2", title="Linear quarter-car models", first="2.2"),
        Section(number="2.3.1", title="Model input", first="2.6"),
        Section(number="2.3.2", title="Friction", first="2.7"),
        Section(number="2.3.3", title="Engine mass", first="2.16"),
        Section(number="2.3.4", title="Nonlinear model with a degressive damper"),
        Section(number="2.4", title="Nonlinear 2D quarter-car model"),
        Section(number="3.1", title="Model components", first="3.1"),
        Section(number="3.2.1", title="Frequency-domain tuning", first="3.3"),
        Section(number="3.2.2", title="Time-domain tuning", first="3.12"),
        Section(number="3.3", title="Validation of the complete-car model", first="3.21"),
        Section(number="3.4", title="Model improvement", first="3.37"),
        Section(number="4.1", title="Varying Coulomb friction", first="4.1"),
        Section(number="4.2", title="Adding damping to the suspension mount", first="4.5"),
        Section(number="4.3", title="Varying suspension mount stiffness", first="4.9"),
        Section(number="4.4", title="Discussion of the parameter sensitivity"),
        Section(number="5", title="Conclusions and recommendations"),
        Section(number="A", title="Switch model", first="A.1"),
        Section(number="B", title="Smooth friction parameter", first="B.1"),
        Section(number="C", title="Nonlinear model with a degressive damper", first="C.1"),
        Section(number="D", title="Nonlinear 2D quarter-car model", first="D.1"),
        Section(number="E", title="Properties of the complete-car model"),
        Section(number="F", title="Final parameter set"),
    ),
    tables={"2.1": "2.2", "2.2": "2.3.2", "2.3": "2.3.3", "3.1": "3.2.1", "3.2": "3.3", "B.1": "B"},
)

HALF_CAR = Source(
    key="half-car",
    short="half car with rider",
    title="*Parametric study of rider's comfort in a vehicle with semi-active suspension system under transient road "
    "conditions*",
    studies=("half_car_rider",),
)

DAMPERS = Source(
    key="dampers",
    short="damper choice, 2014",
    title="Mehmood, Khan and Mehmood, *Dynamic Modeling of Vehicles and Damper*, IOSRJEN 04(04), 2014",
    studies=("damper_choice",),
)

SOURCES = (THESIS, HALF_CAR, DAMPERS)


def source_of(study: str) -> Source:
    """Return the source whose results a study computes.

    Raises:
        KeyError: the study computes no published result.
    """
    for source in SOURCES:
        if study in source.studies:
            return source
    raise KeyError(study)


BESIDE = "focus_measured_roll"
"""Car of the second column: its roll mode is at the measured 5.8 Hz."""

BESIDE_NAME, PRINTED_IXX = "Ixx 1080", "Ixx 1000"

BESIDE_STUDIES: Mapping[str, tuple[str, ...]] = {
    "levels": (),
    "bump": (),
    "stribeck": (),
    "comfort_sensitivity": ("--source-only",),
}
"""Studies of the complete car that run with both cars, and further options of the second run."""


KINDS = ("section", "appendix", "equation", "table", "figure", "")
"""Order of the rows of one section."""

NUMBER = r"(?:[A-F]|\d+)(?:\.\d+)*"

REFERENCE = re.compile(
    rf"\b(section|appendi(?:x|ce)|equation|table|figure|chapter)s?\s+({NUMBER}(?:(?:, | and | to ){NUMBER})*)"
)


@dataclass(frozen=True, slots=True)
class Place:
    """Place of a row in a publication: a figure or table if the text contains one, else a section."""

    kind: str  # type of the place, see `KINDS`; empty for a text without reference
    number: str  # number of the first figure, table or section, or ""
    text: str  # text of the heading

    @property
    def sort_key(self) -> tuple[object, ...]:
        """Return the order within a section: text first, then tables, then figures, each by number."""
        parts = tuple((1, 0, part) if part.isalpha() else (0, int(part), "") for part in self.number.split(".") if part)
        return KINDS.index(self.kind), parts, self.text


def place_of(text: str) -> Place:
    """Return the place that the text of a row names: "section 2.3.2.4, figure 2.13" is at figure 2.13."""
    references = [(reference_type, numbers) for reference_type, numbers in REFERENCE.findall(text)]
    if not references:
        return Place("", "", text.strip().capitalize())
    reference_type, numbers = min(references, key=lambda pair: pair[0] not in {"figure", "table"})
    first = re.split(r", | and | to ", numbers)[0]
    word = "appendix" if reference_type.startswith("appendi") else reference_type
    several = {"appendix": "appendices"}.get(word, f"{word}s")
    heading = f"{word if numbers == first else several} {numbers}"
    return Place({"chapter": "section"}.get(word, word), first, heading[0].upper() + heading[1:])


def section_of(source: Source, location: Place) -> Section | None:
    """Return the section of a publication that contains a place, or None."""
    if location.kind == "table":
        return _named(source, source.tables.get(location.number, location.number))
    if location.kind == "figure":
        return _with_figure(source, location.number)
    return _named(source, location.number) if location.kind else None


def _named(source: Source, number: str) -> Section | None:
    """Return the section of a number, else the section around it, else the first section of its chapter."""
    around = [s for s in source.sections if f"{number}.".startswith(f"{s.number}.")]
    inside = [s for s in source.sections if s.number.startswith(f"{number}.")]
    chapter = [s for s in source.sections if s.number.split(".")[0] == number.split(".")[0]]
    return next(iter((*around, *inside, *chapter)), None)


def _with_figure(source: Source, number: str) -> Section | None:
    chapter, order = _split(number)
    starts = [
        (first[1], section)
        for section in source.sections
        if section.first and (first := _split(section.first))[0] == chapter and first[1] <= order
    ]
    return max(starts, key=lambda pair: pair[0], default=(0, None))[1]


def _split(number: str) -> tuple[str, int]:
    chapter, _, order = number.rpartition(".")
    return chapter, int(order) if order.isdigit() else 0
