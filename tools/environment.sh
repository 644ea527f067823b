#!/usr/bin/env bash
# Makes the virtual environment and installs the package with its locked dependencies.
set -euo pipefail
python=$1
venv=$2
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
  || { echo "needed is Python 3.11 or newer, found $("$python" --version); set PYTHON=/path/to/python3.11"; exit 2; }
[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check \
  --constraint constraints.txt --editable '.[dev,cluster,sensitivity,optimisation,loads,posterior,bench,formats,oracles,browser,notebook,docs]' 2> >(grep -v '^WARNING' >&2)
