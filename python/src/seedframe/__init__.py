"""Seedframe from Python: campaigns of labelled images, and frames on demand (docs/python.md).

Everything is done by the program ``seedframe``, which is found in PATH, beside this package in a checkout, or by ``SEEDFRAME``
in the environment. What goes wrong is an Error with the program's own message.
"""

from concurrent.futures import as_completed

from .aio import AsyncStream
from .campaign import Campaign, Frame
from .convert import to_fiftyone, to_supervision
from .errors import Error
from .labels import Amodal, Camera, Instance, Keypoint, Labels, Pose
from .program import find_program
from .runs import Progress, check, describe, export, resume, submit
from .stream import Request, Stream
from .stream_frame import Batch, StreamFrame
from .views import FrameViews

__all__ = [
    "Amodal",
    "AsyncStream",
    "Batch",
    "Camera",
    "Campaign",
    "Error",
    "Frame",
    "FrameViews",
    "Instance",
    "Keypoint",
    "Labels",
    "Pose",
    "Progress",
    "Request",
    "Stream",
    "StreamFrame",
    "as_completed",
    "check",
    "describe",
    "export",
    "find_program",
    "resume",
    "submit",
    "to_fiftyone",
    "to_supervision",
]
