"""What a stream makes: a frame, and frames in a row."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Error
from .labels import Labels
from .views import FrameViews


class StreamFrame(FrameViews):
    """A frame that was made on demand. Its arrays are memory that the program filled, and live as long as they are used.

    What the frame was not asked for (``want``) raises Error.
    """

    def __init__(self, answer: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        self._answer = answer
        self._arrays = arrays

    def __repr__(self) -> str:
        return f"StreamFrame({self.frame_id[:12]}, {self.fidelity}, {', '.join(self._arrays) or 'no arrays'})"

    @property
    def frame_id(self) -> str:
        """SHA-256 of what was made, hexadecimal: that of `submit` for the same values."""
        return str(self._answer["frame_id"])

    @property
    def fidelity(self) -> str:
        """What made it: "labels", "preview" or "render"."""
        return str(self._answer["fidelity"])

    @property
    def width(self) -> int:
        """Pixels."""
        return int(self._answer["width"])

    @property
    def height(self) -> int:
        """Pixels."""
        return int(self._answer["height"])

    @property
    def pixel_hashes(self) -> dict[str, str]:
        """By pass, as a campaign's manifest has them."""
        return dict(self._answer["pixel_hashes"])

    @property
    def kept(self) -> int | None:
        """The frame's number in the campaign that keeps it; None if it is not kept."""
        kept = self._answer.get("kept")
        return None if kept is None else int(kept)

    @property
    def seconds(self) -> dict[str, float]:
        """``waited`` before it was begun, ``made`` from then on, ``worker``: of that in Blender."""
        return dict(self._answer["seconds"])

    @cached_property
    def labels(self) -> Labels:
        """What is known of its instances."""
        if "labels" not in self._answer:
            raise self._not_wanted("labels")
        return Labels(self._answer["labels"])

    @property
    def image(self) -> npt.NDArray[np.uint8]:
        """The picture: uint8, rows × columns × 3, sRGB. Not at fidelity "labels"."""
        return self._array("image")

    @property
    def ids(self) -> npt.NDArray[np.uint16]:
        """Which instance each pixel belongs to: uint16, rows × columns, 0 is background."""
        return self._array("ids")

    @property
    def depth(self) -> npt.NDArray[np.float32]:
        """Metres along the viewing axis: float32, rows × columns; 1e10 is background."""
        return self._array("depth")

    @cached_property
    def semantic(self) -> npt.NDArray[np.uint8]:
        """The category of each pixel, from `ids` and `labels`: uint8, rows × columns, 0 is background and distractors."""
        return self._semantic_of_ids()

    def _array(self, name: str) -> npt.NDArray[Any]:
        if name not in self._arrays:
            raise self._not_wanted(name)
        return self._arrays[name]

    def _not_wanted(self, name: str) -> Error:
        return Error(f"this frame was not asked for its {name}: name '{name}' in want")


class Batch:
    """Some frames in a row, whose arrays are also one array each: the frames' own memory, nothing is copied."""

    def __init__(self, frames: list[StreamFrame], arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        self.frames = frames
        self._arrays = arrays

    def __len__(self) -> int:
        return len(self.frames)

    @property
    def labels(self) -> list[Labels]:
        """Of each frame."""
        return [frame.labels for frame in self.frames]

    @property
    def image(self) -> npt.NDArray[np.uint8]:
        """uint8, frames × rows × columns × 3, sRGB; contiguous within a frame."""
        return self._array("image")

    @property
    def ids(self) -> npt.NDArray[np.uint16]:
        """uint16, frames × rows × columns, 0 is background; contiguous within a frame."""
        return self._array("ids")

    @property
    def depth(self) -> npt.NDArray[np.float32]:
        """float32, frames × rows × columns, metres; contiguous within a frame."""
        return self._array("depth")

    def _array(self, name: str) -> npt.NDArray[Any]:
        if name not in self._arrays:
            raise Error(f"these frames were not asked for their {name}: name '{name}' in want")
        return self._arrays[name]
