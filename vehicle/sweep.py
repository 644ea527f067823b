"""`python -m vehicle.sweep`: the same as `python -m vehicle sweep`.

`vehicle.sweep` is also a function of Python. An import of this module replaces the function as an attribute of the
package, so the module can be called like the function.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

from vehicle.commands.sweep import main


class CallableModule(ModuleType):
    """Module that calls the function `vehicle.studies.sweeps.plan.sweep`."""

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Run a sweep; see `vehicle.studies.sweeps.plan.sweep`."""
        return import_module("vehicle.studies.sweeps.plan").sweep(*arguments, **options)


if __name__ == "__main__":
    raise SystemExit(main())
sys.modules[__name__].__class__ = CallableModule
