"""Finds the program ``seedframe`` and runs its verbs."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Callable, Union

from .errors import Error, kind_of_exit

StrPath = Union[str, "os.PathLike[str]"]

_ERROR = "seedframe: error: "


def find_program() -> Path:
    """The program: what the environment's ``SEEDFRAME`` names, ``seedframe`` in PATH, or the release build of the checkout
    that this package is in.

    Raises:
        Error: (``environment``) there is none.

    """
    named = os.environ.get("SEEDFRAME", "")
    if named:
        found = shutil.which(named)
        if found:
            return Path(found).absolute()
        raise Error(
            f"the environment's SEEDFRAME is '{named}', which is no program that can be run: let it name the program "
            "'seedframe', or unset it",
            "environment",
        )
    found = shutil.which("seedframe")
    if found:
        return Path(found).absolute()
    # python/src/seedframe/program.py of a checkout; elsewhere there is nothing at that place.
    built = Path(__file__).resolve().parents[3] / "build" / "release" / "seedframe"
    if os.access(built, os.X_OK) and built.is_file():
        return built
    raise Error(
        f"the program 'seedframe' is neither in PATH nor at {built}: install or build it (scripts/setup.sh), or let "
        "SEEDFRAME in the environment name it",
        "environment",
    )


def set_arguments(values: Mapping[str, Any] | None) -> list[str]:
    """``--set path=value`` for each item; text as it is, all else as JSON, which a config reads as well."""
    arguments = []
    for path, value in (values or {}).items():
        text = value if isinstance(value, str) else json.dumps(value)
        arguments += ["--set", f"{path}={text}"]
    return arguments


def error_of(exit_code: int, errors: Iterable[str], otherwise: str) -> Error:
    """What a run that ended with this code and printed these lines to its standard error has to say."""
    messages = [line[len(_ERROR) :] for line in errors if line.startswith(_ERROR)]
    if exit_code < 0:
        messages.append(f"the program was ended by {_signal_name(-exit_code)}")
    return Error("\n".join(messages) or otherwise, kind_of_exit(exit_code), exit_code)


def run(arguments: Iterable[str], told: Callable[[str], None] | None = None) -> str:
    """Runs a verb to its end and returns what it printed.

    Ctrl-C is handed on, once: the program then ends in good order, and KeyboardInterrupt is raised after that. If this
    process is killed, the program ends in good order, too.

    Args:
        arguments: the verb and what follows it.
        told: gets each line of its standard error as it comes, in another thread.

    Raises:
        Error: with the program's own message.

    """
    program = find_program()
    # A session of its own, or a terminal would send Ctrl-C to it besides, which means something else.
    tied = [sys.executable, "-I", "-S", str(Path(__file__).with_name("_tied.py")), str(os.getpid())]
    try:
        process = subprocess.Popen(
            [*tied, str(program), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            encoding="utf-8",
            errors="replace",
        )
    except OSError as why:
        raise Error(f"{program} cannot be started: {why.strerror}", "environment") from why
    errors: list[str] = []
    output: list[str] = []
    failed: list[BaseException] = []

    def listen() -> None:
        assert process.stderr is not None
        for line in process.stderr:
            errors.append(line.rstrip("\n"))
            if told is not None and not failed:
                try:
                    told(errors[-1])
                except BaseException as why:  # of the caller's function, and raised where the caller is
                    failed.append(why)
                    process.send_signal(signal.SIGINT)

    def collect() -> None:
        assert process.stdout is not None
        output.append(process.stdout.read())

    threads = [threading.Thread(target=each, daemon=True) for each in (listen, collect)]
    for thread in threads:
        thread.start()
    interrupted = _wait(process)
    for thread in threads:
        thread.join()
    for pipe in (process.stdout, process.stderr):
        if pipe is not None:
            pipe.close()
    if interrupted:
        raise KeyboardInterrupt
    if failed:
        raise failed[0]
    if process.returncode != 0:
        told_otherwise = "".join(output).strip() or "\n".join(errors[-5:]) or "the program says nothing about it"
        raise error_of(process.returncode, errors, told_otherwise)
    return "".join(output)


def run_json(arguments: Iterable[str]) -> Any:
    """What a verb prints as JSON.

    Raises:
        Error: with the program's own message.

    """
    return json.loads(run(arguments))


def _wait(process: subprocess.Popen[str]) -> bool:
    """Until it has ended; interrupts are handed on, ever more firmly. Whether there were any."""
    firmly = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]
    interrupted = False
    while True:
        try:
            process.wait()
            return interrupted
        except KeyboardInterrupt:
            interrupted = True
            process.send_signal(firmly.pop() if len(firmly) > 1 else firmly[0])


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
