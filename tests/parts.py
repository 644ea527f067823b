"""Two parts of the suite: the product, and what stands around it.

| command | tests |
|---|---|
| `make test`, `python -m pytest` | the product |
| `make test-all` | `make test`, then the rest |
| `python -m pytest --part rest`, `--part all` | only the rest; both |
| `python -m pytest PATH ...` | all of these paths |

Every fault of `tools/mutations.py` is seen by the product alone, whatever part its tests are of.
"""

REST = {
    "benchmarks/": "benchmarks run whole",
    "core/test_binaries.py::test_all_eleven_libraries": "the core is compiled for eleven platforms",
    "documentation/test_examples.py::test_an_example_runs": "every example runs",
    "documentation/test_executed_pages.py": "every command and example of the pages runs",
    "documentation/test_gallery.py": "every page of the gallery runs",
    "documentation/test_site.py": "the documentation is built",
    "drawing/notebook/test_notebooks.py": "the notebooks run whole",
    "faults/": "system calls of commands fail",
    "scenarios/test_": "studies of the sources run",
    "system/test_fuzz.py": "mutated files and options",
    "system/test_hostile_cars.py": "every command on cars with native code",
    "system/test_killed_": "commands killed at a rename, and what a user does then",
    "system/test_installation.py": "the wheel is built and installed",
}
"""Beginning of a test under tests/ to what it does that the product does not need at every change."""

KEPT = (
    "benchmarks/test_counts.py",
    "scenarios/test_claim.py",
    "scenarios/test_interval_probability.py",
    "scenarios/test_damper_optimum.py",
)
"""Modules of these folders that belong to the product: short tests of what the studies compute with."""

PARTS = ("product", "rest", "all")


def is_rest(test: str, *, renders: bool) -> bool:
    """Return True for a test of the rest.

    Args:
        test: its file, relative to tests/, and its name, `FILE::NAME`.
        renders: it renders images of films.
    """
    return renders or (test.startswith(tuple(REST)) and not test.startswith(KEPT))
