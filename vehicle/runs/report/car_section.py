"""Section of a report about the car: drawing, masses, stiffnesses, geometry and parameters."""

from markupsafe import Markup

from vehicle.drawing.rendering.car_drawing import plot_car
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.runs.car import Car
from vehicle.runs.car.car_text import car_tables, parameter_table
from vehicle.runs.report.differences import parameter_words
from vehicle.runs.report.markup import templates
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)

SIZE = (PAGE_WIDTH, 5.4)
"""Width and height of the drawing [inch]."""


def car_section(car: Car) -> Markup:
    """Return drawing and tables of a car, as of `python -m vehicle show`; all parameters are folded."""
    data = car.show()
    wire = car_wireframe(car.model)
    parameters = parameter_table(data.parameters, shortened=False)
    whole, *steady, usual, axles, figures = car_tables(data)
    return fill(
        "car",
        figure=drawing(lambda path: plot_car(path, wire, data, SIZE), f"Drawing of {data.name} with dimensions"),
        car=whole,
        usual=usual,
        axles=axles,
        figures=figures,
        steady=steady,
        notes=data.notes,
        parameters=[(parameter_words(path), path, *row) for path, *row in parameters.rows],
        heads=["parameter", "path", *parameters.heads[1:]],
    )
