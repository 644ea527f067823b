# make shaker   set everything up and run the main job with a film
# make test     set everything up, check and test the product
# make test-all make test, then the rest: studies of the sources, pages of the documentation, films
# make check    format, lint, types and wrapped pages only
# make studies  the studies of the sources, whole (hours) -> docs/published-results.md
# make faults   every system call of every command fails once (hours) -> docs/faults.md
# make core     build the compiled core for all platforms
# make lowest   smoke tests with the lowest versions of the dependencies
# make laptop   a folder for Windows without installation -> build/vehicle-for-windows.zip
# make test-windows   the commands with CPython for Windows under wine, compared with this system
# make docs     build the documentation -> docs/_build/html/index.html
# make course   the notebooks of the course (docs/course) -> build/course
SHELL := /bin/bash
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
INPUT ?= low.csv
export OMP_NUM_THREADS ?= 1

.PHONY: shaker test test-all check core core-sanitize studies faults docs course setup setup-tests tools mjcf benchmark lowest laptop test-windows clean

shaker: setup
	@if $(BIN)/python -m vehicle.drawing.rendering.backend; then \
	  $(BIN)/python -m vehicle.shaker --input $(INPUT) --video --report --force; \
	else \
	  echo "no film: the run goes on without it"; \
	  $(BIN)/python -m vehicle.shaker --input $(INPUT) --report --force; \
	fi

PYTEST := $(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test: setup-tests .stamps/for-tests check
	$(PYTEST) --part product

test-all: test
	$(PYTEST) --part rest

check: setup-tests
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m tools.wrap_docs --check

core: tools
	$(BIN)/python tools/core.py

core-sanitize: setup-tests
	$(BIN)/python tools/core_sanitized.py

docs: setup-tests
	$(BIN)/python -m sphinx -q -W --keep-going -b html docs docs/_build/html

course: setup
	$(BIN)/python tools/course_notebooks.py build/course

mjcf: setup
	$(BIN)/python -m vehicle mjcf --force

# uv resolves the packages of another system than this one.
.stamps/windows: tools/system-libraries.sh tools/windows_folder.py pyproject.toml constraints.txt | setup-tests tools
	@bash tools/system-libraries.sh windows
	@touch $@

laptop: setup-tests .stamps/windows
	$(BIN)/python tools/windows_folder.py build/vehicle-for-windows --zip build/vehicle-for-windows.zip

test-windows: setup-tests .stamps/windows
	$(BIN)/python tools/windows_folder.py "build/under wine ü/vehicle" --for-wine
	$(BIN)/python -m tests.windows "build/under wine ü/vehicle"

studies: setup-tests
	$(BIN)/python -m scenarios.published --force

faults: setup-tests
	$(BIN)/python -m tests.faults

benchmark: setup-tests
	$(BIN)/python -m tests.benchmarks.speed

lowest: .stamps/system
	@bash tools/lowest.sh "$(PYTHON)" build/lowest

# What the job needs; what tests and checks need, the job included.
setup: .stamps/system .stamps/python

setup-tests: .stamps/system .stamps/python-tests

# The compiler of `make core` and the installer of `make laptop`.
tools: setup .stamps/python-tools

# The off-screen OpenGL library; without root it is only named, and films are left out.
.stamps/system: tools/system-libraries.sh
	@mkdir -p .stamps
	@bash tools/system-libraries.sh
	@touch $@

# What tests alone need: a browser for the report, CalculiX for bodies.
.stamps/for-tests: tools/system-libraries.sh
	@mkdir -p .stamps
	@bash tools/system-libraries.sh tests
	@touch $@

.stamps/python: constraints-hashes.txt pyproject.toml tools/environment.sh
	@mkdir -p .stamps
	@bash tools/environment.sh "$(PYTHON)" $(VENV)
	@touch $@

.stamps/python-tests: constraints-hashes.txt pyproject.toml tools/environment.sh
	@mkdir -p .stamps
	@bash tools/environment.sh "$(PYTHON)" $(VENV) tests
	@touch .stamps/python $@

.stamps/python-tools: constraints-hashes.txt tools/environment.sh | .stamps/python
	@bash tools/environment.sh "$(PYTHON)" $(VENV) tools
	@touch $@

clean:
	rm -rf $(VENV) .stamps runs build docs/_build *.egg-info .pytest_cache .mypy_cache .ruff_cache
