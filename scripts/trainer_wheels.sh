#!/bin/sh
# Makes venv/trainers, a virtual environment with the large programs that train on exports: torchvision, torchmetrics
# and ultralytics, with PyTorch (6 GB). Versions are pinned in tests/export/clients/trainers.txt. Run again, it does only
# what is missing.
set -eu
cd "$(dirname "$0")/.."

venv=venv/trainers
pinned=tests/export/clients/trainers.txt
cmp -s "$pinned" "$venv/installed.txt" && exit 0
echo "trainer_wheels.sh: installing PyTorch, torchvision, torchmetrics and ultralytics into $venv: 6 GB, some minutes"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
# Nothing but what is pinned, whatever this machine's pip prefers.
if ! PIP_CONSTRAINT=/dev/null "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps \
    --only-binary :all: -r "$pinned"; then
  echo "trainer_wheels.sh: they could not be installed: is PyPI reached from here, and are 6 GB free?" >&2
  exit 4
fi
cp "$pinned" "$venv/installed.txt"
