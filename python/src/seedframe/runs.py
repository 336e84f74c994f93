"""The program's verbs as functions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

from .campaign import Campaign, path_of
from .program import StrPath, run, run_json, set_arguments

_COUNTS = re.compile(
    r"(?P<done>\d+)/(?P<total>\d+) frames(?:, (?P<failed>\d+) failed)?"
    r"(?:, (?P<rate>[\d.]+) frames/s)?(?:, about (?P<left>.+) left)?$"
)


@dataclass(frozen=True)
class Progress:
    """How far a run is."""

    done: int  #: frames that are made, also by earlier runs
    total: int
    failed: int
    frames_per_s: float | None  #: None as long as it is not known
    left: str | None  #: time that is left, as "3 min 20 s"; None as long as it is not known
    message: str  #: the line of the program: counts, or what happened to a frame

    def __str__(self) -> str:
        return self.message


class _ProgressReader:
    """Lines of the program to calls of a function."""

    def __init__(self, callback: Callable[[Progress], object]) -> None:
        self._callback = callback
        self._counts: tuple[int, int, int, float | None, str | None] = (0, 0, 0, None, None)

    def __call__(self, line: str) -> None:
        if line.startswith("seedframe: error: "):
            return  # raised when the run ends
        found = _COUNTS.search(line)
        if found:
            rate = found["rate"]
            self._counts = (
                int(found["done"]),
                int(found["total"]),
                int(found["failed"] or 0),
                float(rate) if rate else None,
                found["left"],
            )
        self._callback(Progress(*self._counts, line))


def _run_arguments(
    progress: Callable[[Progress], object] | None,
    blender: str | None,
    workers: int | None,
    threads: int | None,
    options: Iterable[str],
) -> list[str]:
    arguments = []
    for name, value in (("--blender", blender), ("--workers", workers), ("--threads", threads)):
        if value is not None:
            arguments += [name, str(value)]
    return [*arguments, *([] if progress else ["--quiet"]), *options]


def submit(
    config: StrPath,
    output: StrPath,
    *,
    set: Mapping[str, Any] | None = None,
    frames: int | None = None,
    blender: str | None = None,
    workers: int | None = None,
    threads: int | None = None,
    overwrite: bool = False,
    progress: Callable[[Progress], object] | None = None,
    options: Sequence[str] = (),
) -> Campaign:
    """Renders a campaign to its end.

    Ctrl-C ends it in good order, as does the end of this process: what is made stays, and `resume` goes on.

    Args:
        config: the campaign's config, a file.
        output: the folder that it becomes.
        set: values of the config by their path, such as ``{"render.samples": 16}``.
        frames: render the first so many only.
        blender: which one: a path, a name in PATH, or ``python:VENV``.
        workers: Blender processes; chosen if it is None.
        threads: of each; chosen if it is None.
        overwrite: remove the campaign that is there.
        progress: is told how far it is, in another thread: at least every ten seconds, and when a frame fails. What it raises
            ends the run in good order and is raised here.
        options: further ones of ``seedframe submit``.

    Returns:
        The campaign.

    Raises:
        Error: ``input``: the config or an argument is wrong; nothing was made. ``render``: frames failed; the others are
            there. ``environment``: there is no Blender, no disk, ….
        KeyboardInterrupt: after it has ended.

    """
    arguments = ["submit", str(config), "-o", str(output), *set_arguments(set)]
    if frames is not None:
        arguments += ["--frames", str(frames)]
    if overwrite:
        arguments += ["--overwrite", "--yes"]
    arguments += _run_arguments(progress, blender, workers, threads, options)
    run(arguments, _ProgressReader(progress) if progress else None)
    return Campaign(output)


def resume(
    campaign: Campaign | StrPath,
    *,
    set: Mapping[str, Any] | None = None,
    blender: str | None = None,
    workers: int | None = None,
    threads: int | None = None,
    progress: Callable[[Progress], object] | None = None,
    options: Sequence[str] = (),
) -> Campaign:
    """Renders exactly what a campaign lacks; what is complete costs nothing.

    Args, returns and errors are those of `submit`. ``set={"scenes": 200}`` adds frames.
    """
    folder = path_of(campaign)
    arguments = ["resume", folder, *set_arguments(set), *_run_arguments(progress, blender, workers, threads, options)]
    run(arguments, _ProgressReader(progress) if progress else None)
    return Campaign(folder)


def export(
    campaign: Campaign | StrPath,
    formats: str | Sequence[str],
    output: StrPath | None = None,
    *,
    split: Mapping[str, float] | None = None,
    options: Sequence[str] = (),
) -> list[Path]:
    """Writes annotations of what is made.

    Args:
        campaign: or its folder.
        formats: names such as ``"coco"``; ``seedframe export --help`` tells them.
        output: where their folders come; ``exports`` in the campaign's if it is None.
        split: shares of the scenes, such as ``{"train": 0.8, "val": 0.2}``.
        options: further ones of ``seedframe export``, such as ``["--partial"]``.

    Returns:
        The folder of each format.

    Raises:
        Error: ``input``: there is no such format or frames are missing. ``corrupt``: files of frames are damaged.

    """
    names = [formats] if isinstance(formats, str) else list(formats)
    folder = path_of(campaign)
    arguments = ["export", folder]
    for name in names:
        arguments += ["--format", name]
    if output is not None:
        arguments += ["-o", str(output)]
    if split:
        arguments += ["--split", ",".join(f"{name}={share}" for name, share in split.items())]
    run([*arguments, *options])
    root = Path(output) if output is not None else Path(folder) / "exports"
    return [root / name for name in names]


def check(config: StrPath, *, set: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Whether a config is right: expands all its frames and looks at some. Renders and writes nothing.

    Returns:
        What ``seedframe check --json`` says: ``frames``, ``categories``, ``assets``, ``warnings``, ….

    Raises:
        Error: (``input``) all mistakes, each with file, line and column.

    """
    found: dict[str, Any] = run_json(["check", str(config), *set_arguments(set), "--json"])
    return found


def describe(config: StrPath, *, set: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The parameters of a config for optimisers: type, unit, range, distribution and present value.

    Returns:
        What ``seedframe check --describe`` says.

    Raises:
        Error: (``input``) the config is wrong.

    """
    found: dict[str, Any] = run_json(["check", str(config), *set_arguments(set), "--describe"])
    return found
