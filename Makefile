# make shaker   set everything up and run the main job with a film
# make test     set everything up, check and test
# make check    format, lint and types only
# make studies  the studies of the sources, whole (hours) -> docs/published-results.md
# make faults   every system call of every command fails once (hours) -> docs/faults.md
# make core     build the compiled core for all platforms (needs ziglang, see tools/core.py)
# make docs     build the documentation -> docs/_build/html/index.html
SHELL := /bin/bash
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
INPUT ?= low.csv
export OMP_NUM_THREADS ?= 1

.PHONY: shaker test check core core-sanitize studies faults docs setup mjcf benchmark clean

shaker: setup
	@if $(BIN)/python -m vehicle.drawing.rendering.backend; then \
	  $(BIN)/python -m vehicle.shaker --input $(INPUT) --video --report --force; \
	else \
	  echo "no film: the run goes on without it"; \
	  $(BIN)/python -m vehicle.shaker --input $(INPUT) --report --force; \
	fi

test: setup .stamps/for-tests check
	$(BIN)/python -m pytest -n 2 --dist loadfile

check: setup
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

core: setup
	$(BIN)/python tools/core.py

core-sanitize: setup
	$(BIN)/python tools/core_sanitized.py

docs: setup
	$(BIN)/python -m sphinx -q -W --keep-going -b html docs docs/_build/html

mjcf: setup
	$(BIN)/python -m vehicle.mjcf --force

studies: setup
	$(BIN)/python -m scenarios.published --force

faults: setup
	$(BIN)/python -m tests.faults

benchmark: setup
	$(BIN)/python -m tests.benchmarks.speed

setup: .stamps/system .stamps/python

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

.stamps/python: constraints.txt pyproject.toml tools/environment.sh
	@mkdir -p .stamps
	@bash tools/environment.sh "$(PYTHON)" $(VENV)
	@touch $@

clean:
	rm -rf $(VENV) .stamps runs build docs/_build *.egg-info .pytest_cache .mypy_cache .ruff_cache
