#!/usr/bin/env bash
# environment.sh PYTHON VENV [EXTRA]: makes the virtual environment and installs the package with its locked
# dependencies, and with those of an extra.
set -euo pipefail
python=$1
venv=$2
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
  || { echo "needed is Python 3.11 or newer, found $("$python" --version); set PYTHON=/path/to/python3.11"; exit 2; }
[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
# Python compiles a module when it is first imported; pip would compile all, of which a run imports a part.
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile \
  --constraint constraints.txt --editable ".${3:+[$3]}" 2> >(grep -v '^WARNING' >&2)
