"""What frames of campaigns and frames on demand have in common."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .labels import Instance, Labels


class FrameViews:
    """What follows from a frame's labels and ids."""

    @property
    def labels(self) -> Labels:
        """What is known of its instances."""
        raise NotImplementedError

    @property
    def image(self) -> npt.NDArray[np.uint8]:
        """The picture: uint8, rows × columns × 3, sRGB."""
        raise NotImplementedError

    @property
    def ids(self) -> npt.NDArray[np.uint16]:
        """Which instance each pixel belongs to: uint16, rows × columns, 0 is background."""
        raise NotImplementedError

    def mask(self, instance: Instance | int) -> npt.NDArray[np.bool_]:
        """The visible pixels of an instance, or of the instance with an id: bool, rows × columns."""
        wanted = instance.id if isinstance(instance, Instance) else instance
        result: npt.NDArray[np.bool_] = self.ids == wanted
        return result

    def masks(self) -> npt.NDArray[np.bool_]:
        """Of `labels.visible`, in its order: bool, N × rows × columns."""
        wanted = np.array([each.id for each in self.labels.visible], np.uint16)
        result: npt.NDArray[np.bool_] = self.ids[None] == wanted[:, None, None]
        return result

    def amodal_mask(self, instance: Instance | int) -> npt.NDArray[np.bool_]:
        """The whole silhouette of an instance as far as it is in the image, also where others hide it: bool, rows × columns."""
        if not isinstance(instance, Instance):
            instance = self.labels.instance(instance)
        labels = self.labels
        mask = np.zeros((labels.height, labels.width), np.bool_)
        x, y, width, height = instance.amodal.box
        left, top = max(x, 0), max(y, 0)
        right, bottom = min(x + width, labels.width), min(y + height, labels.height)
        if left < right and top < bottom:
            silhouette = instance.amodal.silhouette()
            mask[top:bottom, left:right] = silhouette[top - y : bottom - y, left - x : right - x]
        return mask

    def _semantic_of_ids(self) -> npt.NDArray[np.uint8]:
        categories: npt.NDArray[Any] = np.zeros(1 << 16, np.uint8)
        for each in self.labels.instances:
            categories[each.id] = each.category
        result: npt.NDArray[np.uint8] = categories[self.ids]
        return result
