#!/bin/sh
# Makes venv/clients, a virtual environment with the small programs that read exports: pycocotools and webdataset
# (without PyTorch). Versions are pinned. Run again, it does only what is missing.
set -eu
cd "$(dirname "$0")/.."

venv=venv/clients
[ ! -d "$venv/lib/python3.11/site-packages/webdataset-1.0.2.dist-info" ] || exit 0
echo "client_wheels.sh: installing pycocotools 2.0.11 and webdataset 1.0.2 into $venv"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
# webdataset last: that it is there shows that all is.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    numpy==2.3.5 pillow==12.0.0 pyyaml==6.0.3 pycocotools==2.0.11 braceexpand==0.1.7 ||
  ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: webdataset==1.0.2; then
  echo "client_wheels.sh: the readers of exports could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
