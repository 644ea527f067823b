"""Functions of higher packages that methods of `Car` and `Run` call: `vehicle/__init__.py` hands them down.

`run.save` writes files, `run.report` a page. Both are made in packages that import the car, which imports none of them;
`car.steady` makes a run, which imports the car.
"""

from collections.abc import Callable
from typing import Any

HANDED: dict[str, Callable[..., Any]] = {}
"""Name to function: the public `load_run`, `save_car`, `save_run`, `write_report`; `figure_of`, `steady_run` and
`diagnose_car`."""
