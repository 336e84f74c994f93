"""Datasets for PyTorch: one that renders while it trains, and one of a campaign's frames. Needs the package torch."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Callable, Union

from .campaign import Campaign, path_of
from .errors import Error
from .program import StrPath
from .stream import Request, Stream, Values
from .views import FrameViews

try:
    import torch
    from torch.utils.data import Dataset, IterableDataset, get_worker_info
except ImportError as why:
    raise Error("seedframe.torch needs PyTorch, which is not installed: pip install torch", "environment") from why

Transform = Callable[[FrameViews], Any]
Requests = Union[Iterable[Values], Callable[[], Iterable[Values]], None]


def detection_target(frame: FrameViews) -> dict[str, Any]:
    """What torchvision's detectors are trained with: ``boxes`` (float32, N × 4, left top right bottom, pixels), ``labels``
    (int64, N, from 1), ``area`` (float32, N, pixels) and ``iscrowd`` (int64, N, 0) of the visible instances.
    """
    labels = frame.labels
    areas = [float(each.area_px) for each in labels.visible]
    return {
        "boxes": torch.from_numpy(labels.boxes).to(torch.float32),
        "labels": torch.from_numpy(labels.category_ids),
        "area": torch.tensor(areas, dtype=torch.float32),
        "iscrowd": torch.zeros(len(areas), dtype=torch.int64),
    }


def image_and_target(frame: FrameViews) -> tuple[Any, dict[str, Any]]:
    """The picture (float32, 3 × rows × columns, 0 to 1) and `detection_target`."""
    pixels = torch.from_numpy(frame.image).permute(2, 0, 1)
    return pixels.to(torch.float32) / 255, detection_target(frame)


class StreamDataset(IterableDataset):  # type: ignore[misc]
    """Frames that are rendered while they are trained on.

    Each process of a DataLoader has a stream of its own and makes its share of the frames: with n of them, number k makes
    requests k, k + n, …, so that together they make those that one alone would.

    Args:
        config: the campaign's config, a file.
        requests: values of variables, or Requests: an iterable, or a function that gives one for each epoch (of which all
            processes must get the same). None: what the config draws, scene after scene, without end.
        fidelity: "labels", "preview" or "render", as of Stream.
        transform: what is trained on, of a frame; `image_and_target` if it is None.
        first_scene: of the first request; `set_scene` moves it, for frames that no epoch before has seen.
        workers: of each stream.
        set, want, blender, options: as of Stream.

    """

    def __init__(
        self,
        config: StrPath,
        requests: Requests = None,
        *,
        fidelity: str = "preview",
        transform: Transform | None = None,
        first_scene: int = 0,
        workers: int | None = None,
        set: Mapping[str, Any] | None = None,
        want: Sequence[str] | None = None,
        blender: str | None = None,
        options: Sequence[str] = (),
    ) -> None:
        super().__init__()
        self._config = str(config)
        self._requests = requests
        self._transform = transform or image_and_target
        self._first_scene = first_scene
        self._arguments: dict[str, Any] = {
            "fidelity": fidelity,
            "workers": workers,
            "set": set,
            "want": want,
            "blender": blender,
            "options": options,
        }

    def set_scene(self, first_scene: int) -> None:
        """The scene of the first request from the next epoch on."""
        self._first_scene = first_scene

    def __iter__(self) -> Iterator[Any]:
        info = get_worker_info()
        number, count = (info.id, info.num_workers) if info is not None else (0, 1)
        requests: Iterable[Values]
        if self._requests is None:
            requests = itertools.repeat({})
        else:
            requests = self._requests() if callable(self._requests) else self._requests
        mine = itertools.islice(self._numbered(requests), number, None, count)
        with Stream(self._config, **self._arguments) as stream:
            for frame in stream.render(mine):
                yield self._transform(frame)

    def _numbered(self, requests: Iterable[Values]) -> Iterator[Request]:
        for scene, each in enumerate(requests, self._first_scene):
            if not isinstance(each, Request):
                yield Request(each, scene)
            else:
                yield each if each.scene is not None else Request(**{**vars(each), "scene": scene})


class CampaignDataset(Dataset):  # type: ignore[misc]
    """The frames of a campaign that are made, in order.

    Args:
        campaign: or its folder.
        transform: what is trained on, of a frame; `image_and_target` if it is None.

    """

    def __init__(self, campaign: Campaign | StrPath, transform: Transform | None = None) -> None:
        self.campaign = campaign if isinstance(campaign, Campaign) else Campaign(path_of(campaign))
        self._numbers = self.campaign.numbers
        self._transform = transform or image_and_target

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, index: int) -> Any:
        return self._transform(self.campaign.frame(self._numbers[index]))
