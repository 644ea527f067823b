"""Section of a report about the car: drawing, masses, stiffnesses, geometry and parameters."""

from __future__ import annotations

from vehicle.drawing.rendering.car_drawing import plot_car
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.runs.car import Car
from vehicle.runs.car.car_text import TextTable, car_tables, parameter_table
from vehicle.runs.report.markup import Markup, folded, joined, table, tag
from vehicle.runs.report.svg_figure import drawing

SIZE = (PAGE_WIDTH, 5.4)
"""Width and height of the drawing [inch]."""


def car_section(car: Car) -> Markup:
    """Return drawing and tables of a car, as of `python -m vehicle show`; all parameters are folded."""
    data = car.show()
    wire = car_wireframe(car.model)
    whole, usual, axles, figures = car_tables(data)
    parameters = parameter_table(data.parameters, shortened=False)
    return joined(
        [
            drawing(lambda path: plot_car(path, wire, data, SIZE), f"Drawing of {data.name} with dimensions"),
            _table(whole),
            _table(usual),
            _halves(axles),
            _table(figures),
            *(tag("p", note) for note in data.notes),
            folded(f"All {len(parameters.rows)} parameters", table(parameters.heads, parameters.rows, text_columns=5)),
        ]
    )


def _halves(text: TextTable) -> Markup:
    """Return a long table in two halves beside each other, with its notes below."""
    middle = -(-len(text.rows) // 2)
    halves = [table(text.heads, rows) for rows in (text.rows[:middle], text.rows[middle:])]
    return joined([tag("div", *halves, class_="pair"), *(tag("p", note) for note in text.notes)])


def _table(text: TextTable) -> Markup:
    """Return a table of text as an HTML table with its notes."""
    heads = text.heads or (text.title, "")
    columns = 1 if text.heads else len(heads)
    return joined([table(heads, text.rows, text_columns=columns), *(tag("p", note) for note in text.notes)])
