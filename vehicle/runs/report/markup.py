"""HTML of the pages, from the templates in the folder `templates` beside a module; all values are escaped."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from vehicle.digits import number

MANY = 30
"""Maximum number of rows of a table that is not folded."""


def templates(module: str) -> Callable[..., Markup]:
    """Return a function that fills the templates of a module.

    Args:
        module: file of the module, `__file__`.

    Returns:
        Function of the name of a template, without its ending, and of its values by name, which returns the HTML.
    """

    def fill(name: str, /, **values: object) -> Markup:
        return Markup(_environment(Path(module).parent).get_template(f"{name}.html").render(values))

    return fill


def named(name: str, title: str) -> Markup:
    """Return a title in words that shows the name in the program when the pointer rests on it."""
    return Markup('<span title="{}">{}</span>').format(name, title)


@cache
def _environment(folder: Path) -> Environment:
    """Return the environment of the templates of a folder; elements.html has the elements of all."""
    folders = [folder / "templates", Path(__file__).parent / "templates"]
    environment = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["number"] = number
    environment.globals["MANY"] = MANY
    elements = vars(environment.get_template("elements.html").module)
    environment.globals |= {name: element for name, element in elements.items() if not name.startswith("_")}
    return environment
