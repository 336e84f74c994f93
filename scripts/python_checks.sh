#!/bin/sh
# Checks the Python package: types by mypy, style by ruff, installed by pip into an environment without the checkout, and
# its datasets where PyTorch is (scripts/torch_wheels.sh). Tools are pinned, in venv/python-checks.
#
#   scripts/python_checks.sh           all
#   scripts/python_checks.sh install   only what is missing of the tools
set -eu
cd "$(dirname "$0")/.."

venv=venv/python-checks
if [ ! -d "$venv/lib/python3.11/site-packages/mypy-2.4.1.dist-info" ]; then
  echo "python_checks.sh: installing mypy 2.4.1 and ruff 0.17.6 into $venv"
  [ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
  # mypy last: that it is there shows that all is.
  if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
      numpy==2.3.5 ruff==0.17.6 setuptools==84.2.1 wheel==0.48.0 packaging==26.4 typing-extensions==4.16.0 \
      mypy-extensions==1.2.0 pathspec==1.1.1 librt==0.17.0 ast-serialize==0.13.1 ||
    ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: mypy==2.4.1; then
    echo "python_checks.sh: mypy and ruff could not be installed: is PyPI reached from here?" >&2
    exit 4
  fi
fi
[ "${1:-}" != install ] || exit 0

"$venv/bin/ruff" check --quiet --no-cache python
"$venv/bin/ruff" format --quiet --no-cache --check python
"$venv/bin/mypy" --config-file python/pyproject.toml --cache-dir "$venv/mypy" python/src
program=${SEEDFRAME_TESTED:-build/release/seedframe}
program=$(cd "$(dirname "$program")" && pwd)/$(basename "$program")

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Built from a copy: setuptools leaves folders beside what it builds.
cp -r python "$scratch/source"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --no-index --no-build-isolation \
  --target "$scratch/installed" "$scratch/source"
cat >"$scratch/user.py" <<'END'
import pathlib, sys
import seedframe
assert pathlib.Path(seedframe.__file__).is_relative_to(sys.argv[1]), seedframe.__file__
assert pathlib.Path(seedframe.__file__).with_name("py.typed").exists()
with seedframe.Stream(sys.argv[2], want=["labels", "ids"]) as stream:
    (batch,) = stream.render_batches(({} for _ in range(4)), 4)
assert batch.ids.shape == (4, 128, 128), batch.ids.shape
END
SEEDFRAME=$program PYTHONPATH=$scratch/installed "$venv/bin/python" -B "$scratch/user.py" "$scratch" configs/bench_small.yaml
printf 'import seedframe\nframes = seedframe.Stream("a.yaml").render([{}])\nreveal_type(next(frames).ids)\n' >"$scratch/user_types.py"
# A user's mypy sees the types of what is installed.
MYPYPATH=$scratch/installed "$venv/bin/mypy" --strict --cache-dir "$venv/mypy-user" "$scratch/user_types.py" |
  grep -q 'Revealed type is "numpy.ndarray.*unsignedinteger' || {
  echo "python_checks.sh: mypy does not see the types of the installed package" >&2
  exit 1
}
if [ -x venv/torch/bin/python ]; then
  SEEDFRAME_TESTED=$program venv/torch/bin/python -B -m unittest discover --start-directory python/tests --pattern 'test_torch.py'
else
  echo "python_checks.sh: the datasets for PyTorch were not tested: scripts/torch_wheels.sh installs it"
fi
