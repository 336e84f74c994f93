"""Frames on demand for asyncio."""

from __future__ import annotations

import asyncio
import collections
from collections.abc import AsyncIterable, AsyncIterator, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from .program import StrPath
from .stream import Request, Stream, Values
from .stream_frame import StreamFrame


class AsyncStream:
    """A Stream whose waiting is asyncio's: ``async with AsyncStream(config) as stream``.

    Args are those of Stream; the program starts in ``async with``, which raises what Stream raises.
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
        self._arguments: tuple[Any, ...] = (config, fidelity, workers)
        self._options: dict[str, Any] = {
            "set": set,
            "want": want,
            "blender": blender,
            "keep": keep,
            "options": options,
        }
        self._opened: Stream | None = None

    async def __aenter__(self) -> AsyncStream:
        self._loop = asyncio.get_running_loop()
        opening = self._loop.run_in_executor(None, lambda: Stream(*self._arguments, **self._options))
        try:
            self._opened = await asyncio.shield(opening)
        except asyncio.CancelledError:
            opening.add_done_callback(_close_unused)
            raise
        self._room = asyncio.Semaphore(self._opened.most_open)
        return self

    async def __aexit__(self, kind: object, error: object, trace: object) -> None:
        await self.close(cancel=kind is not None)

    async def close(self, cancel: bool = False) -> None:
        """Ends the program and waits for it, as Stream.close does."""
        stream = self._stream
        await self._loop.run_in_executor(None, lambda: stream.close(cancel))

    @property
    def _stream(self) -> Stream:
        if self._opened is None:
            raise RuntimeError("an AsyncStream starts in 'async with'")
        return self._opened

    @property
    def variables(self) -> dict[str, dict[str, Any]]:
        """What values can be given for, as Stream.variables."""
        return self._stream.variables

    @property
    def ready(self) -> dict[str, Any]:
        """What the program said first, as Stream.ready."""
        return self._stream.ready

    async def submit(self, values: Values | None = None, *, scene: int | None = None) -> asyncio.Future[StreamFrame]:
        """Asks for a frame, when there is room for it.

        Args:
            values: of variables by name, or a Request.
            scene: in place of the request's.

        Returns:
            A future that gives the frame or raises Error, as that of Stream.submit. Cancelling it cancels the request.

        Raises:
            Error: the stream is closed or its program has ended.

        """
        request = values if isinstance(values, Request) else Request(values)
        if scene is not None:
            request = replace(request, scene=scene)
        await self._room.acquire()
        try:
            future = self._stream._ask(request, None, self._answered)
        except BaseException:
            self._room.release()
            raise
        return asyncio.wrap_future(future)

    def _answered(self) -> None:
        """In the stream's thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._room.release)

    async def frame(self, values: Values | None = None, *, scene: int | None = None) -> StreamFrame:
        """A frame: `submit`, and what comes of it."""
        return await (await self.submit(values, scene=scene))

    async def render(
        self,
        requests: Iterable[Values] | AsyncIterable[Values],
        *,
        first_scene: int = 0,
        ahead: int | None = None,
    ) -> AsyncIterator[StreamFrame]:
        """Frames in the order of their requests, as Stream.render gives them; the requests may be asynchronous, too.

        Raises:
            Error: when a frame could not be made; what was asked for after it is cancelled.

        """
        stream = self._stream
        most = min(ahead or stream._ahead, stream.most_open)
        window: collections.deque[asyncio.Future[StreamFrame]] = collections.deque()
        index = first_scene
        try:
            async for each in _each(requests):
                request = each if isinstance(each, Request) else Request(each)
                window.append(await self.submit(request, scene=index if request.scene is None else None))
                index += 1
                if len(window) >= most:
                    yield await window.popleft()
            while window:
                yield await window.popleft()
        finally:
            for future in window:
                future.cancel()

    async def as_completed(
        self, requests: Iterable[Values] | AsyncIterable[Values], *, first_scene: int = 0
    ) -> AsyncIterator[tuple[int, StreamFrame]]:
        """Frames as they are made, each with the place of its request, from 0. Scenes and errors are those of `render`."""
        most = self._stream._ahead
        waiting: dict[asyncio.Future[StreamFrame], int] = {}
        index = 0
        try:
            async for each in _each(requests):
                request = each if isinstance(each, Request) else Request(each)
                scene = first_scene + index if request.scene is None else None
                waiting[await self.submit(request, scene=scene)] = index
                index += 1
                while len(waiting) >= most:
                    done, _ = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
                    for future in done:
                        yield waiting.pop(future), future.result()
            while waiting:
                done, _ = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
                for future in done:
                    yield waiting.pop(future), future.result()
        finally:
            for future in waiting:
                future.cancel()


async def _each(requests: Iterable[Values] | AsyncIterable[Values]) -> AsyncIterator[Values]:
    if isinstance(requests, AsyncIterable):
        async for request in requests:
            yield request
    else:
        for request in requests:
            yield request


def _close_unused(opening: asyncio.Future[Stream]) -> None:
    if not opening.cancelled() and opening.exception() is None:
        opening.result().close(cancel=True)
