#!/bin/sh
# Makes venv/torch, a virtual environment with PyTorch for the CPU, in which scripts/bench.sh detector trains small
# networks on what Seedframe renders. Versions are pinned. Run again, it does only what is missing.
set -eu
cd "$(dirname "$0")/.."

venv=venv/torch
[ ! -d "$venv/lib/python3.11/site-packages/torch-2.13.0.dist-info" ] || exit 0
echo "torch_wheels.sh: installing PyTorch 2.13.0 into $venv"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
# PyTorch last: that it is there shows that all is.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: \
    numpy==2.3.5 pillow==12.0.0 matplotlib==3.10.7 ||
  ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: torch==2.13.0; then
  echo "torch_wheels.sh: PyTorch could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
