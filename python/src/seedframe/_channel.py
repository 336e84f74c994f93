"""The program `seedframe stream` and the lines that go to and from it (docs/formats/stream.md).

One thread reads and writes; whoever asks for frames waits only while as many are open as the program takes. The program ends
when its standard input does, so it goes with this process, however that ends.
"""

from __future__ import annotations

import collections
import contextlib
import json
import os
import select
import signal
import subprocess
import threading
import weakref
from collections.abc import Mapping
from typing import Any, Callable

from ._memory import Layout, Shelf, map_file
from ._open_request import FrameFuture, Make, OpenRequest, T, plain_values, settle
from .errors import Error
from .program import error_of, find_program

PROTOCOL = 1
_LOOK_AFTER_MS = 1000  # whether the program still runs, should anybody else hold its pipes open
_END_S = 10.0  # that the program may take to end when it is asked to
_FILES_GO_FIRST_S = 1.0  # from when an ending program's files are closed until it has ended


_channels: weakref.WeakSet[Channel] = weakref.WeakSet()


class Channel:
    """A running program and its open requests.

    Raises:
        Error: it does not start.

    """

    def __init__(self, arguments: list[str]) -> None:
        program = find_program()
        try:
            # A session of its own: Ctrl-C in a terminal or a notebook is for this process, which decides what ends.
            self._process = subprocess.Popen(
                [str(program), "stream", *arguments],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
                start_new_session=True,
            )
        except OSError as why:
            raise Error(f"{program} cannot be started: {why.strerror}", "environment") from why
        process = self._process
        assert process.stdin is not None and process.stdout is not None and process.stderr is not None
        self._pipes = (process.stdin, process.stdout, process.stderr)
        for pipe in self._pipes:
            os.set_blocking(pipe.fileno(), False)
        self._woken, self._waker = os.pipe()
        os.set_blocking(self._woken, False)
        os.set_blocking(self._waker, False)
        self._owner = os.getpid()
        self._room = threading.Condition()  # guards _open, _next, _closing, _ended
        self._open: dict[int, OpenRequest[Any]] = {}
        self._next = 0
        self._closing = False
        self._ended: Error | None = None
        self._writing = threading.Lock()  # guards _unsent, and standard input
        self._unsent = bytearray()
        self._said = b""
        self._stderr: collections.deque[str] = collections.deque(maxlen=200)
        self._stderr_rest = ""
        self._has_begun = threading.Event()
        self.ready: dict[str, Any] = {}
        self.most_open = 64
        self._thread = threading.Thread(target=self._run, name="seedframe stream", daemon=True)
        _channels.add(self)
        self._thread.start()
        try:
            self._has_begun.wait()
        except BaseException:
            self.close(cancel=True)
            raise
        if not self.ready:
            self._thread.join()
            assert self._ended is not None
            raise self._ended

    @property
    def process_id(self) -> int:
        """Of the program."""
        return self._process.pid

    def ask(
        self,
        request: Mapping[str, Any],
        make: Make[T],
        place: tuple[Shelf, int] | None = None,
        answered: Callable[[], None] | None = None,
    ) -> FrameFuture[T]:
        """Sends a request; waits while `most_open` are open. What is wrong with it is in the future.

        Args:
            request: without an id.
            make: what the future gets.
            place: where arrays are mapped.
            answered: is called when the request is open no longer, also if it was cancelled.

        Raises:
            Error: the stream is closed, or the program has ended.

        """
        with self._room:
            while len(self._open) >= self.most_open and self._ended is None and not self._closing:
                self._room.wait()
            self._require_running()
            number = self._next
            self._next += 1
            future: FrameFuture[T] = FrameFuture(lambda: self._cancel(number))
            try:
                line = json.dumps({"id": number, **request}, default=plain_values, allow_nan=False)
            except (TypeError, ValueError) as why:
                future.set_exception(Error(f"values that JSON cannot say: {why}. Numbers are finite, names are text"))
                line = ""
            else:
                self._open[number] = OpenRequest(future, make, place, answered)
        if line:
            self._send(line)
        elif answered is not None:
            answered()
        return future

    def close(self, cancel: bool = False) -> None:
        """Ends the program and waits for it.

        Args:
            cancel: what has not been begun is not made.

        """
        if os.getpid() != self._owner:
            return  # a fork's copy: the program is its parent's
        with self._room:
            self._closing = True
            self._room.notify_all()
        self._wake()
        if threading.current_thread() is self._thread:
            self._end_process()
            return
        if cancel:
            self._end_process()
        try:
            self._thread.join()
        except BaseException:
            self._end_process()
            self._thread.join()
            raise

    def _require_running(self) -> None:
        if os.getpid() != self._owner:
            raise Error(
                f"this stream is of process {self._owner}, which has forked process {os.getpid()}: open a stream in each "
                "process"
            )
        if self._ended is not None:
            raise self._ended
        if self._closing:
            raise Error("this stream is closed: open another one")

    def _cancel(self, number: int) -> None:
        with self._room:
            is_open = number in self._open and self._ended is None
        if is_open:
            self._send(json.dumps({"cancel": number}))

    def _end_process(self) -> None:
        """Asks it to end, and sees to it."""
        process = self._process
        with contextlib.suppress(OSError):
            process.terminate()
        try:
            process.wait(_END_S)
        except BaseException as why:
            with contextlib.suppress(OSError):
                process.kill()
            if not isinstance(why, subprocess.TimeoutExpired):
                raise

    # ---- Lines to the program

    def _send(self, line: str) -> None:
        with self._writing:
            self._unsent += line.encode() + b"\n"
            is_all = self._flush()
        if not is_all:
            self._wake()

    def _flush(self) -> bool:
        """Writes what fits. Whether that was all."""
        while self._unsent:
            try:
                written = os.write(self._pipes[0].fileno(), self._unsent)
            except BlockingIOError:
                return False
            except (OSError, ValueError):  # it has ended, which its output will tell
                self._unsent.clear()
                return True
            del self._unsent[:written]
        return True

    def _wake(self) -> None:
        with contextlib.suppress(OSError):  # there is a byte already, or nobody to wake
            os.write(self._waker, b"\0")

    # ---- Lines from the program, in a thread of their own

    def _run(self) -> None:
        trouble: Error | None = None
        try:
            self._listen()
        except Exception as why:  # of what the program says, or of ourselves: no future must wait for ever
            trouble = Error(f"what 'seedframe stream' says is not understood: {why!r}", "internal")
            self._process.kill()
        self._end(trouble)

    def _listen(self) -> None:
        stdin, stdout, stderr = (pipe.fileno() for pipe in self._pipes)
        poll = select.poll()
        for descriptor in (stdout, stderr, self._woken):
            poll.register(descriptor, select.POLLIN)
        writes = False
        while True:
            with self._writing:
                if not self._pipes[0].closed:
                    is_all = self._flush()
                    if is_all and self._closing:
                        if writes:
                            poll.unregister(stdin)
                        self._pipes[0].close()
                        writes = False
                    elif is_all == writes:
                        poll.unregister(stdin) if writes else poll.register(stdin, select.POLLOUT)
                        writes = not writes
            happened = dict(poll.poll(_LOOK_AFTER_MS))
            if not happened and self._process.poll() is not None:
                return
            if self._woken in happened:
                os.read(self._woken, 4096)
            if stderr in happened and not self._take_errors(stderr):
                poll.unregister(stderr)
            if stdout in happened and not self._take_output(stdout):
                return

    def _take_errors(self, descriptor: int) -> bool:
        data = _read(descriptor)
        if data is None:
            return True
        *lines, self._stderr_rest = (self._stderr_rest + data.decode("utf-8", "replace")).split("\n")
        self._stderr.extend(lines)
        return bool(data)

    def _take_output(self, descriptor: int) -> bool:
        data = _read(descriptor)
        if data is None:
            return True
        *lines, self._said = (self._said + data if self._said else data).split(b"\n")
        for line in lines:
            if line:
                self._take_line(json.loads(line))
        return bool(data)

    def _take_line(self, message: dict[str, Any]) -> None:
        if "ready" in message:
            ready = message["ready"]
            if ready["protocol"] != PROTOCOL:
                raise ValueError(f"protocol {ready['protocol']}, and this package speaks {PROTOCOL}: install its own")
            self.most_open = int(ready.get("most_open", self.most_open))
            self.ready = ready
            self._has_begun.set()
        elif "id" in message and message["id"] is not None:
            self._take_answer(message)

    def _take_answer(self, message: dict[str, Any]) -> None:
        number = message["id"]
        entry = self._open[number]
        result: Any = None
        error: BaseException | None = None
        told = message.get("error")
        if told is not None:
            error = Error(told["message"], told["kind"])
        else:
            layout: Layout = message.get("arrays") or {}
            try:
                arrays: Mapping[str, Any] = {}
                if layout and not entry.future.cancelled():
                    arrays = entry.place[0].place(entry.place[1], layout) if entry.place else map_file(layout)
                result = entry.make(message, arrays)
            except Exception as why:
                if layout and not os.path.exists(layout["path"]) and self._has_ended():
                    return  # its files went with it: this request fails with all that are open
                error = why
            if layout:
                self._send(json.dumps({"release": number}))
        # Only now there is room for another one: the program counts what is not released, too.
        with self._room:
            del self._open[number]
            self._room.notify()
        settle(entry, result, error)

    def _has_ended(self) -> bool:
        try:
            self._process.wait(_FILES_GO_FIRST_S)
        except subprocess.TimeoutExpired:
            return False
        return True

    def _end(self, trouble: Error | None) -> None:
        """The program has ended, or is not understood: all that is open fails."""
        process = self._process
        try:
            exit_code = process.wait(_END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            exit_code = process.wait()
        with contextlib.suppress(OSError, ValueError):
            while self._take_errors(self._pipes[2].fileno()):
                if not select.select([self._pipes[2]], [], [], 0)[0]:
                    break
        lines = [*self._stderr, self._stderr_rest]
        if exit_code == 0 or (self._closing and exit_code in (130, -signal.SIGTERM)):
            ended = Error("this stream has ended", "interrupted", exit_code)
        else:
            last = "\n".join(line for line in lines[-5:] if line)
            ended = error_of(exit_code, lines, f"'seedframe stream' ended with exit code {exit_code}. {last}".strip())
        with self._room:
            self._ended = trouble or ended
            entries = list(self._open.values())
            self._open.clear()
            self._closing = True
            self._room.notify_all()
        with self._writing:
            self._close_pipes()
        for entry in entries:
            settle(entry, None, self._ended)
        self._has_begun.set()

    def _close_pipes(self) -> None:
        for pipe in self._pipes:
            with contextlib.suppress(OSError):
                pipe.close()
        for descriptor in (self._woken, self._waker):
            with contextlib.suppress(OSError):
                os.close(descriptor)
        self._waker = self._woken = -1

    def forget(self) -> None:
        """In a fork: lets go of the pipes, or the program would not see the end of the process that it is of."""
        self._close_pipes()
        self._process.returncode = 0  # it is no child of this process, and not to be waited for
        self._room = threading.Condition()
        self._writing = threading.Lock()


def _forget_all() -> None:
    for channel in list(_channels):
        channel.forget()


os.register_at_fork(after_in_child=_forget_all)


def _read(descriptor: int) -> bytes | None:
    """What is there; empty at the end; None: nothing now."""
    try:
        return os.read(descriptor, 1 << 20)
    except BlockingIOError:
        return None
