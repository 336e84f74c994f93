"""Frames for other people's programs, where they are installed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from .campaign import Campaign, Frame
from .errors import Error
from .views import FrameViews


def _missing(package: str) -> Error:
    return Error(f"the package {package} is not installed: pip install {package}", "environment")


def to_supervision(frame: FrameViews) -> Any:
    """A frame's visible instances as ``supervision.Detections``.

    Args:
        frame: of a campaign, or of a stream with "labels" and "ids".

    Returns:
        Detections: ``xyxy`` in pixels, ``mask``, ``class_id`` from 0 (category 1 is 0), ``tracker_id`` the instance's id, and
        in ``data`` the names of the classes (``class_name``) and the share of each that is seen (``visible_fraction``).

    Raises:
        Error: (``environment``) supervision is not installed.

    """
    try:
        import supervision
    except ImportError as why:
        raise _missing("supervision") from why
    labels = frame.labels
    visible = labels.visible
    return supervision.Detections(
        xyxy=labels.boxes.astype(np.float32),
        mask=frame.masks(),
        class_id=labels.category_ids.astype(int) - 1,
        tracker_id=np.array([each.id for each in visible], int),
        data={
            "class_name": np.array([each.category_name for each in visible], dtype=str),
            "visible_fraction": np.array([each.visible_fraction for each in visible], float),
        },
    )


def to_fiftyone(campaign: Campaign, name: str | None = None, frames: Iterable[Frame] | None = None) -> Any:
    """A campaign as a ``fiftyone.Dataset``: a sample for each frame, with the visible instances, their boxes and masks.

    Pictures stay where they are. Samples have ``frame_number`` and ``ground_truth``, detections ``instance_id``, ``asset``,
    ``visible_fraction`` and ``truncation``.

    Args:
        campaign: with pictures.
        name: of the dataset; FiftyOne chooses one if it is None.
        frames: those of the campaign that are wanted; all if it is None.

    Raises:
        Error: ``environment``: FiftyOne is not installed. ``input``: the campaign has no pictures.

    """
    try:
        import fiftyone
    except ImportError as why:
        raise _missing("fiftyone") from why
    dataset = fiftyone.Dataset(name)
    for frame in campaign if frames is None else frames:
        labels = frame.labels
        detections = []
        for each in labels.visible:
            x, y, width, height = each.box
            detections.append(
                fiftyone.Detection(
                    label=each.category_name,
                    bounding_box=[x / labels.width, y / labels.height, width / labels.width, height / labels.height],
                    mask=frame.mask(each)[y : y + height, x : x + width],
                    instance_id=each.id,
                    asset=each.asset,
                    visible_fraction=each.visible_fraction,
                    truncation=each.truncation,
                )
            )
        sample = fiftyone.Sample(filepath=str(frame.image_path.absolute()))
        sample["frame_number"] = frame.number
        sample["ground_truth"] = fiftyone.Detections(detections=detections)
        dataset.add_sample(sample)
    return dataset
