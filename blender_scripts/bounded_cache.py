"""A cache of Blender datablocks with a bound on their total size."""

import collections


class BoundedCache:
    """Least recently used goes first. What the present frame uses is never dropped, so one frame may
    exceed the bound."""

    def __init__(self, bound, remove):
        self._bound = bound
        self._remove = remove
        self._entries = collections.OrderedDict()  # key -> (value, size, last frame)
        self._total = 0
        self._frame = 0

    def next_frame(self):
        self._frame += 1

    def get(self, key, make):
        """The cached value, or that of `make`, which returns (value, size)."""
        if key in self._entries:
            value, size, _ = self._entries[key]
            self._entries.move_to_end(key)
        else:
            value, size = make()
            self._total += size
        self._entries[key] = (value, size, self._frame)
        return value

    def trim(self):
        while self._total > self._bound and self._entries:
            key, (value, size, last_frame) = next(iter(self._entries.items()))
            if last_frame == self._frame:
                return
            del self._entries[key]
            self._total -= size
            self._remove(value)
