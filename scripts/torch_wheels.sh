#!/bin/sh
# Makes venv/torch, a virtual environment with PyTorch for the CPU, in which scripts/bench.sh detector trains small
# networks on what Seedframe renders. Versions are pinned. Run again, it does only what is missing.
set -eu
cd "$(dirname "$0")/.."

venv=venv/torch
for installed in "$venv"/lib/python3.11/site-packages/torch-2.13.0*.dist-info; do # or 2.13.0+cpu
  [ ! -d "$installed" ] || exit 0
done
echo "torch_wheels.sh: installing PyTorch 2.13.0 into $venv"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
# All that PyTorch and matplotlib ask for. PyTorch last: that it is there shows that all is.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    numpy==2.3.5 pillow==12.0.0 matplotlib==3.10.7 contourpy==1.3.3 cycler==0.12.1 fonttools==4.68.0 \
    kiwisolver==1.5.1 packaging==26.4 pyparsing==3.3.3 python-dateutil==2.9.0.post0 six==1.17.0 \
    filelock==4.3.1 fsspec==2026.9.0 jinja2==3.1.6 markupsafe==3.0.4 mpmath==1.3.0 networkx==3.6.1 \
    setuptools==84.2.1 sympy==1.14.0 typing-extensions==4.16.0 ||
  ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: torch==2.13.0; then
  echo "torch_wheels.sh: PyTorch could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
