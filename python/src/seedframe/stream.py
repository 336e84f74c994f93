"""Frames on demand: values of a config's variables in, labels and arrays out, from a program that stays."""

from __future__ import annotations

import collections
import os
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any, Callable, Literal, Union, overload

from ._channel import Channel
from ._memory import Shelf
from ._open_request import FrameFuture
from .errors import Error
from .program import StrPath, set_arguments
from .stream_frame import Batch, StreamFrame


@dataclass(frozen=True)
class Request:
    """One frame to be made. What is None is as the stream has it."""

    values: Mapping[str, Any] | None = None  #: of variables by name; what is left out is drawn
    scene: int | None = None  #: whose draws are made for what is left out
    fidelity: str | None = None  #: "labels", "preview" or "render"
    samples: int | None = None  #: per pixel, of "render" alone
    denoise: bool | None = None  #: of "render" alone; True: as ``render.denoise`` says, or by "oidn" where that is off
    crop: tuple[int, int, int, int] | None = None  #: x, y, width, height: only these pixels are made, of "render" alone
    want: Sequence[str] | None = None  #: of "labels", "image", "ids", "depth"
    deadline_s: float | None = None  #: seconds after which it is an error


Values = Union[Mapping[str, Any], Request]


class Stream:
    """A program that makes frames for values of a config's variables, and stays.

    Use it in a ``with`` statement: at its end what is open is made, after an exception it is dropped. The program goes with
    this process, however it ends; Ctrl-C is for this process alone.

    Methods may be called from several threads. A process that is forked needs a stream of its own.

    Args:
        config: the campaign's config, a file.
        fidelity: of requests that do not say. "labels": exact ids, depth and labels, no picture, milliseconds. "preview": and
            a shaded picture, for looking. "render": by Blender, as a campaign.
        workers: threads or Blender processes; chosen if it is None.
        set: values of the config by their path, such as ``{"render.width": 128}``.
        want: of "labels", "image", "ids", "depth"; ``["labels"]``, and "image" where there is a picture, if it is None.
        blender: which one: a path, a name in PATH, or ``python:VENV``.
        keep: folder of a campaign that what is rendered becomes: made, or gone on with if a stream of this config has made it.
            A frame is on the disk when it is given; `StreamFrame.kept` is its number there.
        options: further ones of ``seedframe stream``.

    Raises:
        Error: ``input``: the config is wrong. ``environment``: there is no program.

    """

    def __init__(
        self,
        config: StrPath,
        fidelity: str = "labels",
        workers: int | None = None,
        *,
        set: Mapping[str, Any] | None = None,
        want: Sequence[str] | None = None,
        blender: str | None = None,
        keep: StrPath | None = None,
        options: Sequence[str] = (),
    ) -> None:
        arguments = [str(config), "--fidelity", fidelity, *set_arguments(set)]
        for name, value in (("--workers", workers), ("--blender", blender), ("--keep", keep)):
            if value is not None:
                arguments += [name, str(value)]
        self._fidelity = fidelity
        self._want = want
        self._channel = Channel([*arguments, *options])
        self._ahead = min(self._channel.most_open, 4 * (workers or os.cpu_count() or 1))
        self._finalizer = weakref.finalize(self, self._channel.close, cancel=True)

    def __reduce__(self) -> Any:
        raise TypeError("a Stream is of one process: open one where it is needed")

    def __enter__(self) -> Stream:
        return self

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self.close(cancel=kind is not None)

    def close(self, cancel: bool = False) -> None:
        """Ends the program and waits for it. Closing again does nothing.

        Args:
            cancel: drop what has not been begun, instead of making it first.

        """
        self._finalizer.detach()
        self._channel.close(cancel)

    @property
    def variables(self) -> dict[str, dict[str, Any]]:
        """What values can be given for: by name ``type`` ("number", "vector" or "name"), ``unit`` and ``per_copy``."""
        return dict(self._channel.ready["variables"])

    @property
    def ready(self) -> dict[str, Any]:
        """What the program said first: ``name``, ``seed``, ``width``, ``height``, ``categories``, ``process``, …"""
        return dict(self._channel.ready)

    @property
    def most_open(self) -> int:
        """Requests that can be open at once; `submit` waits when there are as many."""
        return self._channel.most_open

    def submit(
        self,
        values: Values | None = None,
        *,
        scene: int | None = None,
        fidelity: str | None = None,
        samples: int | None = None,
        denoise: bool | None = None,
        crop: tuple[int, int, int, int] | None = None,
        want: Sequence[str] | None = None,
        deadline_s: float | None = None,
    ) -> Future[StreamFrame]:
        """Asks for a frame. Waits only while `most_open` are open, so do not call it in what a future calls when it is done.

        Args:
            values: of variables by name: numbers in the variable's unit, lists, texts; NumPy's are fine. Or a Request.
            scene, fidelity, samples, denoise, crop, want, deadline_s: as in Request, and in place of what it says.

        Returns:
            Its future, for ``concurrent.futures.as_completed``, ``wait`` and the like. It gives the frame or raises Error:
            ``input``: a value is wrong, the frame came too late, or it was cancelled; ``render``: no worker could make it;
            ``environment``: the program has ended. A wrong request does not end the stream.

        Raises:
            Error: the stream is closed or its program has ended.

        """
        asked: dict[str, Any] = {
            "scene": scene,
            "fidelity": fidelity,
            "samples": samples,
            "denoise": denoise,
            "crop": crop,
            "want": want,
            "deadline_s": deadline_s,
        }
        request = values if isinstance(values, Request) else Request(values)
        return self._ask(replace(request, **{name: value for name, value in asked.items() if value is not None}))

    def _ask(
        self,
        request: Request,
        place: tuple[Shelf, int] | None = None,
        answered: Callable[[], None] | None = None,
    ) -> FrameFuture[StreamFrame]:
        message: dict[str, Any] = {"values": request.values if request.values is not None else {}}
        for name in ("scene", "fidelity", "samples", "denoise", "deadline_s"):
            value = getattr(request, name)
            if value is not None:
                message[name] = value
        if request.crop is not None:
            message["crop"] = list(request.crop)
        want = request.want if request.want is not None else self._want
        if want is None:
            want = ["labels"] if (request.fidelity or self._fidelity) == "labels" else ["labels", "image"]
        message["want"] = [want] if isinstance(want, str) else list(want)
        return self._channel.ask(message, StreamFrame, place, answered)

    @overload
    def render(
        self,
        requests: Iterable[Values],
        *,
        first_scene: int = 0,
        ahead: int | None = None,
        return_errors: Literal[False] = False,
    ) -> Iterator[StreamFrame]: ...
    @overload
    def render(
        self,
        requests: Iterable[Values],
        *,
        first_scene: int = 0,
        ahead: int | None = None,
        return_errors: Literal[True],
    ) -> Iterator[StreamFrame | Error]: ...
    def render(
        self,
        requests: Iterable[Values],
        *,
        first_scene: int = 0,
        ahead: int | None = None,
        return_errors: bool = False,
    ) -> Iterator[StreamFrame | Error]:
        """Frames in the order of what they are asked for by; several are made at once.

        Request k is made with the draws of scene `first_scene` + k where it names none: the frames are those of a campaign
        whose ``graphs`` are these values, line by line.

        Args:
            requests: values of variables, or Requests; read as frames are taken, at most `ahead` before them.
            first_scene: of the first one.
            ahead: how many are asked for before they are taken; some for each worker if it is None.
            return_errors: give the Error in the place of a frame that could not be made, instead of raising it.

        Raises:
            Error: when a frame could not be made; what was asked for after it is cancelled.

        """
        for future in self._in_order(requests, first_scene, ahead, None):
            try:
                yield future.result()
            except Error as error:
                if not return_errors:
                    raise
                yield error

    def render_batches(
        self,
        requests: Iterable[Values],
        size: int,
        *,
        first_scene: int = 0,
        ahead: int | None = None,
        drop_last: bool = False,
    ) -> Iterator[Batch]:
        """Frames in batches whose arrays are stacked in memory, without a copy.

        Args:
            requests, first_scene, ahead: as of `render`.
            size: frames of a batch. The last one may have fewer.
            drop_last: leave that out.

        Raises:
            Error: when a frame could not be made, or those of a batch have different arrays.

        """
        if size < 1:
            raise ValueError(f"size is {size}, and a batch has at least one frame")
        shelves: collections.deque[Shelf] = collections.deque()

        def place(index: int) -> tuple[Shelf, int]:
            if index % size == 0:
                shelves.append(Shelf(size))
            return shelves[-1], index % size

        frames: list[StreamFrame] = []
        for future in self._in_order(requests, first_scene, ahead, place):
            frames.append(future.result())
            if len(frames) == size:
                yield Batch(frames, shelves.popleft().arrays(size))
                frames = []
        if frames and not drop_last:
            yield Batch(frames, shelves.popleft().arrays(len(frames)))

    def _in_order(
        self,
        requests: Iterable[Values],
        first_scene: int,
        ahead: int | None,
        place: Callable[[int], tuple[Shelf, int]] | None,
    ) -> Iterator[FrameFuture[StreamFrame]]:
        most = min(ahead or self._ahead, self.most_open)
        window: collections.deque[FrameFuture[StreamFrame]] = collections.deque()
        try:
            for index, each in enumerate(requests):
                request = each if isinstance(each, Request) else Request(each)
                if request.scene is None:
                    request = replace(request, scene=first_scene + index)
                window.append(self._ask(request, place(index) if place else None))
                if len(window) >= most:
                    yield window.popleft()
            while window:
                yield window.popleft()
        finally:
            for future in window:
                future.cancel()
