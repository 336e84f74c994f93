"""Files in memory that another process has made, as NumPy arrays without a copy.

By the system's own mmap: Python's keeps a descriptor for each, of which a process has few, and cannot put one behind another.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import threading
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Error

_PROT_NONE, _PROT_READ, _PROT_WRITE = 0, 1, 2
_MAP_PRIVATE, _MAP_FIXED, _MAP_ANONYMOUS, _MAP_NORESERVE = 0x02, 0x10, 0x20, 0x4000
_FAILED = ctypes.c_void_p(-1).value

_libc = ctypes.CDLL(None, use_errno=True)
_mmap = _libc.mmap
_mmap.restype = ctypes.c_void_p
_mmap.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int, ctypes.c_int, ctypes.c_int, ctypes.c_long]
_munmap = _libc.munmap
_munmap.restype = ctypes.c_int
_munmap.argtypes = [ctypes.c_void_p, ctypes.c_size_t]


def _checked(address: int | None) -> int:
    if address is None or address == _FAILED:
        why = os.strerror(ctypes.get_errno())
        raise Error(
            f"the arrays of a frame cannot be mapped: {why}. A process can keep some 60,000 frames; copy what is to be kept "
            "longer",
            "environment",
        )
    return address


def _up_to_page(size: int) -> int:
    return -(-size // mmap.PAGESIZE) * mmap.PAGESIZE


class _Memory:
    """Addresses that go when nothing refers to them any longer."""

    def __init__(self, address: int, size: int) -> None:
        self.address = address
        self._size = size

    def __del__(self, munmap: Any = _munmap) -> None:
        munmap(self.address, self._size)

    def array(
        self, offset: int, dtype: str, shape: Sequence[int], strides: Sequence[int] | None = None
    ) -> npt.NDArray[Any]:
        """A view, which keeps the memory. It can be written to; the writer's pages are copied then, and nobody else sees."""
        return np.asarray(_View(self, offset, dtype, shape, strides))


class _View:
    def __init__(
        self, memory: _Memory, offset: int, dtype: str, shape: Sequence[int], strides: Sequence[int] | None
    ) -> None:
        self.memory = memory
        self.__array_interface__ = {
            "version": 3,
            "data": (memory.address + offset, False),
            "typestr": np.dtype(dtype).str,
            "shape": tuple(shape),
            "strides": None if strides is None else tuple(strides),
        }


Layout = Mapping[str, Any]  # `arrays` of an answer: path, bytes, and by name offset, dtype, shape


def _names(layout: Layout) -> list[str]:
    return [name for name, value in layout.items() if isinstance(value, Mapping)]


def map_file(layout: Layout) -> dict[str, npt.NDArray[Any]]:
    """The arrays of one answer.

    Raises:
        Error: (``environment``) the file is gone, or there is no room for it.

    """
    size = int(layout["bytes"])
    descriptor = _open(layout)
    try:
        memory = _Memory(_checked(_mmap(None, size, _PROT_READ | _PROT_WRITE, _MAP_PRIVATE, descriptor, 0)), size)
    finally:
        os.close(descriptor)
    return {name: memory.array(**layout[name]) for name in _names(layout)}


def _open(layout: Layout) -> int:
    try:
        return os.open(layout["path"], os.O_RDONLY | os.O_CLOEXEC)
    except OSError as why:
        raise Error(
            f"the arrays of a frame cannot be opened at {layout['path']}: {why.strerror}", "environment"
        ) from why


class Shelf:
    """The files of several answers of the same layout, one behind another, so that they are one array."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._lock = threading.Lock()
        self._memory: _Memory | None = None
        self._slot = 0
        self._layout: Layout = {}

    def place(self, index: int, layout: Layout) -> dict[str, npt.NDArray[Any]]:
        """Maps the file of answer `index` at its place, and returns its own arrays.

        Raises:
            Error: as `map_file`; also if its arrays have other shapes than those before it.

        """
        wanted = {name: layout[name] for name in _names(layout)}
        with self._lock:
            if self._memory is None:
                self._layout = wanted
                self._slot = _up_to_page(int(layout["bytes"]))
                size = self._slot * self._count
                flags = _MAP_PRIVATE | _MAP_ANONYMOUS | _MAP_NORESERVE
                self._memory = _Memory(_checked(_mmap(None, size, _PROT_NONE, flags, -1, 0)), size)
        if wanted != self._layout:
            raise Error("frames of a batch need the same arrays of the same size: ask for all with the same want")
        descriptor = _open(layout)
        try:
            place = self._memory.address + index * self._slot
            flags = _MAP_PRIVATE | _MAP_FIXED
            _checked(_mmap(place, int(layout["bytes"]), _PROT_READ | _PROT_WRITE, flags, descriptor, 0))
        finally:
            os.close(descriptor)
        start = index * self._slot
        return {
            name: self._memory.array(start + each["offset"], each["dtype"], each["shape"])
            for name, each in wanted.items()
        }

    def arrays(self, count: int) -> dict[str, npt.NDArray[Any]]:
        """Of the first `count` answers: for each name an array with one dimension more."""
        if self._memory is None:
            return {}
        arrays = {}
        for name, each in self._layout.items():
            one = np.empty(0, each["dtype"])
            strides = [one.itemsize]
            for side in reversed(each["shape"][1:]):
                strides.insert(0, strides[0] * side)
            arrays[name] = self._memory.array(
                each["offset"], each["dtype"], [count, *each["shape"]], [self._slot, *strides]
            )
        return arrays
