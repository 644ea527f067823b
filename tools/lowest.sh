#!/usr/bin/env bash
# lowest.sh PYTHON VENV: installs the lowest versions of the core dependencies that pyproject.toml allows, all others as
# in constraints.txt, and runs the smoke tests: the first tutorial, and a test of each dependency.
set -euo pipefail
python=$1
venv=$2
smoke=(tests/documentation/test_executed_pages.py::'test_a_page_runs_and_prints_what_it_shows[docs/tutorials/first-run.md]'
  tests/engines/simulation/test_native.py tests/model/assembly/test_joints.py tests/studies/sweeps/test_case_evaluation.py
  tests/signals/analysis/test_frf.py tests/signals/analysis/test_weighting.py tests/runs/report/test_templates.py
  tests/runs/report/test_page.py tests/drawing/rendering/test_backend.py tests/drawing/rendering/test_film.py
  tests/drawing/rendering/test_plots.py)
"$python" -m venv "$venv"
core=$("$python" -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"])')
for requirement in $core; do
  pinned+=("${requirement/>=/==}")
  names+=(-e "^${requirement%%>=*}==")
done
others=$venv/constraints.txt
grep -v -i "${names[@]}" constraints.txt >"$others"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile \
  --constraint "$others" "${pinned[@]}" pytest pytest-xdist 2> >(grep -v "^WARNING" >&2)
# Old versions warn about what their newer requirements will remove.
"$venv/bin/python" -m pytest -n 2 -W ignore::DeprecationWarning "${smoke[@]}"
