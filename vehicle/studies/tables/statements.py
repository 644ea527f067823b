"""Statements of a table: each row as a point, a number, a curve or a remark, in the words and units of the file."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from vehicle.errors import DataError
from vehicle.studies.tables.axes import stated_axes
from vehicle.studies.tables.carsim_rows import carsim_rows
from vehicle.studies.tables.cell_units import length_unit, name_and_unit
from vehicle.studies.tables.cells import WITH_UNIT, CellTable, Row, read_cells
from vehicle.studies.tables.headers import Heads, read_heads
from vehicle.studies.tables.name_words import AXLES, SIDES, NameWords, name_words, right_letters, words_of
from vehicle.studies.tables.number_names import QUALIFIERS, QUANTITIES, number_of
from vehicle.studies.tables.point_names import is_template_name, point_of
from vehicle.studies.tables.turned_numbers import TYRE_SIZE, turned_numbers
from vehicle.studies.tables.turned_points import turned_points
from vehicle.studies.tables.tyre_file import TyreFile
from vehicle.studies.tables.unit_factor import unit_factor


@dataclass(frozen=True, kw_only=True, slots=True)
class Point:
    """Row of a point: its words, coordinates in the unit of the file, and the unit, "" if none is stated."""

    where: str
    name: NameWords
    at: tuple[float, float, float]
    unit: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Number:
    """Row of a number: its words, value (a text for the size of a tyre), unit, and the texts of its other cells."""

    where: str
    name: NameWords
    value: float | str
    unit: str
    note: str = ""


@dataclass(frozen=True, kw_only=True, slots=True)
class Curve:
    """Block of two columns of a damper: axle ("" if none is stated), velocities and forces with their units."""

    where: str
    axle: str
    rows: tuple[tuple[float, float], ...]
    units: tuple[str, str]


@dataclass(slots=True)
class Statements:
    """Statements of a file, in its order.

    Attributes:
        file: name of the file.
        points, numbers, curves: its rows.
        bushings: rows of stiffness or damping along x, y, z, with the unit.
        remarks: texts outside these rows, which may state units, axes and the origin.
        guessed, left_out: guesses, and texts that are not understood, with their places.
        tyre: tyre of a `.tir` file; None in other files.
    """

    file: str
    points: list[Point] = field(default_factory=list)
    numbers: list[Number] = field(default_factory=list)
    curves: list[Curve] = field(default_factory=list)
    bushings: list[Point] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    guessed: list[tuple[str, str]] = field(default_factory=list)
    left_out: list[tuple[str, str]] = field(default_factory=list)
    tyre: TyreFile | None = None


_AXLE_TITLE = re.compile(r"\b(front|rear) (axle|suspension|hardpoints)\b|\b(vorder|hinter)achse", re.IGNORECASE)
_INCLUDED = re.compile(r"\b(incl|inkl|including|with|mit)\b.*")
_ORIGIN = re.compile(r"\borigin\b|\bursprung\b", re.IGNORECASE)
_SENTENCE = re.compile(r"\b(is|are|was|were|has|have|ist|sind|hat)\b|\.$", re.IGNORECASE)
"""Marks of a sentence on an axle, which is no title of rows."""
LONGEST_TITLE = 6
"""Most words of a title that does not begin with the axle or its points."""
_FIRST = {*AXLES, *SIDES, "hardpoint", "hardpoints", "points", "coordinates"}


def statements(path: Path) -> Statements:
    """Read the statements of a CSV, text or XLSX file.

    Raises:
        ConfigurationError: the file is missing or too large.
        DataError: it is no table, or a name or a number is ambiguous.
    """
    content = Statements(file=path.name)
    if path.suffix.lower() == ".par":
        rows, others = carsim_rows(path)
        table = CellTable(rows=tuple(rows), comma="thousands")
        if others:
            content.left_out.append(("", f"keywords of no number of a car here: {', '.join(dict.fromkeys(others))}"))
        _Reader(table=table, content=content, letters={}, stem="").read()
        return content
    table = read_cells(path)
    table = replace(table, rows=turned_points(turned_numbers(table.rows, content.guessed)))
    names = [row.cells[0] for row in table.rows if row.cells]
    _Reader(table=table, content=content, letters=right_letters(names), stem=path.stem).read()
    return content


@dataclass(slots=True)
class _Reader:
    table: CellTable
    content: Statements
    letters: dict[str, str]
    stem: str
    heads: Heads | None = None
    axle: str = ""
    side: str = ""
    unit: str = ""
    per_wheel: str = ""
    placed: bool = False
    curve: list[tuple[float, float]] = field(default_factory=list)
    coordinates: dict[tuple[str, str, str], dict[str, tuple[float, str, str, NameWords]]] = field(default_factory=dict)

    def read(self) -> None:
        sheet = None
        for row in self.table.rows:
            if row.sheet != sheet:
                sheet, self.heads, self.unit = row.sheet, None, ""
                self._title(row.sheet)
            cells = [cell for cell in row.cells if cell]
            if not cells:
                self.heads = None
            elif cells[0].startswith(("#", "!", "%", "//")):
                self._remark(" ".join(cells), title=False)
            elif not self._row(row):
                text = " ".join(cells)
                is_remark = bool(length_unit(text) or _ORIGIN.search(text) or stated_axes([text], row.where))
                has_number = any(map(str.isdigit, " ".join(cells[1:]))) or re.search(r"[:=] *\d", text)
                if (has_number or (len(cells) > 1 and self._names_number(cells[0]))) and not is_remark:
                    self.content.left_out.append((row.where, f"{', '.join(cells)[:60]!r}: not understood"))
                self._remark(text, title=not is_remark)
        for (_, axle, side), parts in self.coordinates.items():
            self._joined(parts, axle, side)

    def _names_number(self, text: str) -> bool:
        """Return True for the name of a number, whose row has none: "kerb mass, #REF!, kg"."""
        words = words_of(text)
        named = name_words(text, right_letter="") if len({*words} & set(AXLES)) < 2 else None
        return named is not None and number_of(named) is not None

    def _row(self, row: Row) -> bool:
        """Read a row of numbers or a header; False for a text."""
        row = self._whole_name(row)
        values = [self.table.number(row, cell) for cell in row.cells]
        if self.heads is not None and self.heads.is_curve:
            pair = [values[self.heads.columns[key]] if self.heads.columns[key] < len(values) else None
                    for key in ("velocity", "force")]  # fmt: skip
            if None not in pair:
                self._curve_row(row, pair)  # type: ignore[arg-type]
                return True
            self.heads = None
        if not any(value is not None for value in values) and not any(map(WITH_UNIT.fullmatch, row.cells)) \
                and not any(map(TYRE_SIZE.fullmatch, row.cells)):  # fmt: skip
            return self._header(row)
        if self.heads is not None and (triples := self.heads.triples):
            text = self._cell(row, "name")
            for letter in triples:
                at = [values[self.heads.columns[f"{letter}{axis}"]] for axis in "xyz"]
                if None not in at and text:
                    unit, name = self.heads.units[f"{letter}x"] or self._cell(row, "unit"), self._name(row, text)
                    self.content.bushings.append(Point(where=row.where, name=name, at=tuple(at), unit=unit))  # type: ignore[arg-type]
            return True
        if self.heads is not None and "x" in self.heads.columns:
            return self._point_row(row, values)
        return self._plain_row(row, values)

    def _whole_name(self, row: Row) -> Row:
        """Join a name with commas that are not in quotes: "lower arm, front point,0.1,0.2,0.3" has a cell too much."""
        extra = 0 if self.heads is None else len(row.cells) - self.heads.width
        if extra <= 0 or self.heads is None or self.heads.columns["name"] != 0:
            return row
        return Row(where=row.where, sheet=row.sheet, cells=(", ".join(row.cells[: extra + 1]), *row.cells[extra + 1 :]))

    def _header(self, row: Row) -> bool:
        heads = read_heads(row)
        if heads is None:
            return False
        if self.heads is None and self.placed and "value" in heads.columns:
            self._title("")
        # "Front suspension (mm), X, Y, Z": the head of the names is a title.
        title, unit = name_and_unit(row.cells[heads.columns["name"]])
        if {*words_of(title)} & set(AXLES):
            self._title(title)
        self.unit = unit or self.unit
        self.heads = heads
        in_use = {*heads.columns.values(), *heads.names, *heads.axles}
        others = [cell for index, cell in enumerate(row.cells) if cell and index not in in_use]
        if others and (heads.triples or heads.is_curve or "x" in heads.columns):
            self.content.left_out.append((row.where, f"columns {', '.join(others)}: not read"))
        for index in heads.limits:
            self.content.left_out.append((row.where, f"column {row.cells[index]!r}: not of the empty car"))
        return True

    def _point_row(self, row: Row, values: Sequence[float | None]) -> bool:
        heads = self.heads
        assert heads is not None  # fmt: skip
        numbers = [values[heads.columns[key]] if heads.columns[key] < len(values) else None for key in "xyz"]
        text = row.cells[heads.columns["name"]] if heads.columns["name"] < len(row.cells) else ""
        if None in numbers or not text:
            if text and all(number is None for number in numbers):
                return self._plain_row(row, values)
            raise DataError(f"{row.where}: point {text!r} has no three coordinates; complete or remove the row")
        unit = self._cell(row, "unit") or heads.units["x"] or self.unit
        name = self._name(row, text)
        self._add_point(row, name, (numbers[0], numbers[1], numbers[2]), unit)  # type: ignore[arg-type]
        return True

    def _plain_row(self, row: Row, values: Sequence[float | None]) -> bool:
        """Read name, value and unit; name and three coordinates; or name and a value of each axle."""
        heads = None if row.is_loose else self.heads
        at = heads.columns["name"] if heads is not None and "name" in heads.columns else next(
            (index for index, cell in enumerate(row.cells) if cell and values[index] is None), -1)  # fmt: skip
        if at < 0 or at >= len(row.cells) or not row.cells[at]:
            raise DataError(f"{row.where}: {', '.join(filter(None, row.cells))} has no name; name each row of numbers")
        if heads is not None and len(heads.names) > 1:
            # A symbol and its description: the first that is known.
            others = [index for index in heads.names if index < len(row.cells) and row.cells[index]]
            at = next((index for index in others if number_of(self._name(row, name_and_unit(row.cells[index])[0]))), at)
        text, unit = name_and_unit(row.cells[at])
        unit = self._cell(row, "unit") or unit
        columns = {} if heads is None else heads.columns
        skipped = {index for key, index in columns.items() if key == "unit" or key.startswith("skip")}
        if heads is not None and heads.axles:
            filled = [index for index in heads.axles if index < len(row.cells) and row.cells[index]]
            whole = number_of(name_words(text, right_letter=""))
            # "Total weight,1400,," below front and rear is the weight of the car.
            is_whole = len(filled) == 1 and whole is not None and QUANTITIES[whole[0]].of_axle is False
            if is_whole:
                self.content.guessed.append((row.where, f"{text!r}: of the car, in the column of one axle"))
            for index, (axle, side) in heads.axles.items():
                cell = row.cells[index] if index < len(row.cells) else ""
                joined = WITH_UNIT.fullmatch(cell)
                size = TYRE_SIZE.fullmatch(cell)
                number = self.table.number(row, joined[1] if joined and not size else cell)
                if number is not None or size:
                    of_cell = joined[2] if joined and not size else unit or heads.units.get(f"axle{index}", "")
                    name = self._name(row, text, *(("", "") if is_whole else (axle, side)))
                    self._add_number(row, name, cell if size else number, of_cell)
                elif cell.strip("-–"):
                    self.content.left_out.append((row.where, f"{text!r}: {cell!r} is not understood"))
            return True
        after = [(index, value) for index, value in enumerate(values) if value is not None and index not in skipped]
        if heads is not None and "value" in heads.columns:
            after = [(index, value) for index, value in after if index == heads.columns["value"]]
        if len(after) == 3 and after[2][0] - after[0][0] == 2 and number_of(self._name(row, text)) is None:
            self._add_point(row, self._name(row, text), tuple(value for _, value in after), unit or self.unit)  # type: ignore[arg-type]
            return True
        if heads is None and self.placed:
            # Numbers after the points of an axle and an empty row describe the car.
            self._title("")
        if not after:
            joined = next(filter(None, map(WITH_UNIT.fullmatch, row.cells)), None)
            size = next(filter(None, map(TYRE_SIZE.fullmatch, row.cells)), None)
            if size is not None:
                self._add_number(row, self._name(row, text), size[0], "")
                return True
            number = None if joined is None else self.table.number(row, joined[1])
            if joined is None or number is None or unit_factor(joined[2]) is None:
                return False
            self._add_number(row, self._name(row, text), number, joined[2])
            return True
        index, value = after[0]
        following = next((row.cells[other] for other in range(index + 1, len(row.cells))
                          if row.cells[other] and values[other] is None), "")  # fmt: skip
        listed = number_of(self._name(row, text))
        if unit_factor(following.strip("()[]")) is not None:
            # "sprung mass (ms), 1250, kg": the text after the value takes precedence.
            unit = following
        elif not unit and listed is not None:
            # A column of units before the values.
            dimension = QUANTITIES[listed[0]].dimension
            of_cells = ((cell, unit_factor(cell, dimension)) for cell in row.cells[at + 1 : index])
            unit = next((cell for cell, factor in of_cells if factor and factor.dimension == dimension), "")
        if more := [row.cells[other] for other, _ in after[1:]]:
            self.content.left_out.append((row.where, f"{text!r}: the further values {', '.join(more)[:60]}; the first "
                                          "one counts"))  # fmt: skip
        self._add_number(row, self._name(row, text), value, unit)
        return True

    def _add_number(self, row: Row, name: NameWords, value: float | str | None, unit: str) -> None:
        """Enter a number; "wheel centre x" is a coordinate of a point."""
        last = name.terms[-1] if name.terms else ""
        if last in ("x", "y", "z") and isinstance(value, float) and number_of(name) is None:
            point = NameWords(text=re.sub(r"[\s_,.-]*[xyzXYZ]$", "", name.text), terms=name.terms[:-1], axle=name.axle,
                              side=name.side)  # fmt: skip
            if (key := point_of(point)) is not None and key != "cog":
                self.coordinates.setdefault((key, name.axle, name.side), {})[last] = (value, unit, row.where, point)
                return
        assert value is not None  # fmt: skip
        note = " ".join((*(cell for cell in row.cells if name_and_unit(cell)[0] != name.text), self.per_wheel))
        self.content.numbers.append(Number(where=row.where, name=name, value=value, unit=unit, note=note))

    def _joined(self, parts: dict[str, tuple[float, str, str, NameWords]], axle: str, side: str) -> None:
        _, unit, where, name = next(iter(parts.values()))
        if set(parts) != set("xyz"):
            raise DataError(f"{where}: point {name.text!r} lacks {', '.join(sorted(set('xyz') - set(parts)))}; add it")
        at = (parts["x"][0], parts["y"][0], parts["z"][0])
        self.content.points.append(Point(where=where, name=name, at=at, unit=unit or self.unit))

    def _add_point(self, row: Row, name: NameWords, at: tuple[float, float, float], unit: str) -> None:
        # The name of a file, "front.csv", holds for its points alone: a table of numbers is one of the car.
        ends = {word for word in words_of(self.stem) if word in AXLES}
        if not name.axle and len(ends) == 1:
            name = replace(name, axle=ends.pop())
        self.content.points.append(Point(where=row.where, name=name, at=at, unit=unit))
        self.placed = True

    def _curve_row(self, row: Row, pair: tuple[float, float]) -> None:
        heads, last = self.heads, self.content.curves[-1] if self.content.curves else None
        assert heads is not None  # fmt: skip
        units = (heads.units["velocity"], heads.units["force"])
        if last is None or not self.curve:
            last = Curve(where=row.where, axle=self.axle, rows=(), units=units)
            self.content.curves.append(last)
        self.curve.append((pair[0], pair[1]))
        self.content.curves[-1] = Curve(where=last.where, axle=last.axle, rows=tuple(self.curve), units=units)

    def _name(self, row: Row, text: str, axle: str = "", side: str = "") -> NameWords:
        """Return the words of a name, with axle and side of its columns, its column head or the title above."""
        letter = self.letters.get(row.cells[0], self.letters.get(text, ""))
        if index := re.search(r"\(([12])(?:,([12]))?\)$", text):
            # CarSim counts axles and sides: L_TRACK(2), RRE(1,2).
            text, axle = text[: index.start()], AXLES[int(index[1]) - 1]
            side = SIDES[int(index[2]) - 1] if index[2] else side
        name = name_words(text, right_letter=letter, where=row.where)
        if point_of(name) in (None, "cog") and number_of(name) is None and not QUALIFIERS & set(words_of(text)):
            plain = re.sub(r"\([^)]*\)", " ", text)
            if name.has("unsprung"):
                plain = _INCLUDED.sub(" ", plain)
            name = name_words(plain, right_letter=letter, where=row.where)
        column = words_of(self._cell(row, "axle"))
        axle = axle or next((word for word in column if word in AXLES), "")
        if (name.has("link") or is_template_name(text)) and name.axle and (axle or self.axle):
            # "Lower front link" below the title of the rear axle: front is its place.
            name = replace(name, terms=(*name.terms, name.axle), axle="")
        said = words_of(self._cell(row, "side"))
        both = {"left", "right"} <= set(said)
        side = side or ("" if both else next((word for word in said if word in ("left", "right", "single")), ""))
        return NameWords(text=text, terms=name.terms, axle=axle or name.axle or self.axle,
                         side=side or name.side or self.side)  # fmt: skip

    def _cell(self, row: Row, sort: str) -> str:
        index = None if self.heads is None else self.heads.columns.get(sort)
        return row.cells[index] if index is not None and index < len(row.cells) else ""

    def _remark(self, text: str, *, title: bool) -> None:
        """Keep a text; a title such as "Front axle [mm]" holds for the rows below."""
        self.content.remarks.append(text)
        self.curve = []
        terms = words_of(text)
        if _SENTENCE.search(text.strip()) or (len(terms) > LONGEST_TITLE and terms[0] not in _FIRST):
            if "quarter" in terms:
                self.per_wheel = "per wheel"
        elif title:
            self._title(text)
        elif (match := _AXLE_TITLE.search(text)) and not _ORIGIN.search(text[: match.start()]):
            self.axle = "front" if match[0].lower()[0] in "fv" else "rear"
        if unit := length_unit(text):
            self.unit = unit

    def _title(self, text: str) -> None:
        terms = words_of(text)
        ends = {word for word in terms if word in AXLES}
        sides = {word for word in terms if word in ("left", "right")}
        self.placed = False
        self.per_wheel = "per wheel" if {"quarter", "corner"} & set(terms) else ""
        self.axle = ends.pop() if len(ends) == 1 else ""
        self.side = sides.pop() if len(sides) == 1 else ""
