"""A request that is on its way: its future, and what becomes of its answer."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Future
from typing import Any, Callable, Generic, TypeVar

import numpy as np

from ._memory import Shelf

T = TypeVar("T")
Make = Callable[[Mapping[str, Any], Mapping[str, Any]], T]  # of an answer and its arrays


class FrameFuture(Future[T]):
    """A frame that was asked for. Cancelling tells the program."""

    def __init__(self, cancel: Callable[[], None]) -> None:
        super().__init__()
        self._tell = cancel

    def cancel(self) -> bool:
        """As that of any Future; a frame that is being rendered is not waited for."""
        if not super().cancel():
            return False
        self._tell()
        return True


class OpenRequest(Generic[T]):
    """A request that is not answered."""

    def __init__(self, future: FrameFuture[T], make: Make[T], place: tuple[Shelf, int] | None, answered: Any) -> None:
        self.future = future
        self.make = make
        self.place = place
        self.answered: Callable[[], None] | None = answered


def settle(entry: OpenRequest[Any], result: Any, error: BaseException | None) -> None:
    """Gives the future what it waits for, unless it was cancelled."""
    if entry.answered is not None:
        entry.answered()
    if not entry.future.set_running_or_notify_cancel():
        return
    if error is not None:
        entry.future.set_exception(error)
    else:
        entry.future.set_result(result)


def plain_values(value: Any) -> Any:
    """NumPy's numbers and arrays as JSON has them."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} is a {type(value).__name__}")
