"""What the tests of the decoders make their small examples with."""

from __future__ import annotations

import io
import json
import tempfile
import unittest
from pathlib import Path

import numpy as np
import voc
from PIL import Image


def mask_of(*rows: str) -> np.ndarray:
    """'#' is set."""
    return np.array([[letter == "#" for letter in row] for row in rows])


def png(values: np.ndarray, mode: str | None = None) -> bytes:
    """An image file; palette images get VOC's colours."""
    image = Image.fromarray(values, mode)
    if mode == "P":
        image.putpalette(voc.colour_map().ravel().tolist())
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()


class InFolder(unittest.TestCase):
    """Tests that write files."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, path: str, content: bytes | str | dict | list) -> None:
        file = self.folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, dict | list):
            content = json.dumps(content)
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
