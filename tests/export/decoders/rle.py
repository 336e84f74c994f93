"""COCO's compressed run lengths: text <-> runs <-> mask.

Runs go down the columns, the first is background. Each number is cut into groups of five bits,
lowest first; a group is the character 48 + bits, + 32 when another follows; bit 16 of the last
group is the sign. From the fourth run on, the difference to the run two before is stored.
"""

from __future__ import annotations

import numpy as np


def runs_of_text(text: str) -> list[int]:
    """Decodes the string; ValueError if it ends within a number or has a foreign character."""
    runs: list[int] = []
    value = shift = 0
    open_number = False
    for letter in text:
        group = ord(letter) - 48
        if not 0 <= group < 64:
            raise ValueError(f"{letter!r} is no part of run lengths")
        value |= (group & 31) << shift
        shift += 5
        open_number = bool(group & 32)
        if open_number:
            continue
        if group & 16:
            value -= 1 << shift
        if len(runs) > 2:
            value += runs[-2]
        runs.append(value)
        value = shift = 0
    if open_number:
        raise ValueError("run lengths end within a number")
    return runs


def text_of_runs(runs: list[int]) -> str:
    """The shortest string of these runs, the only one that pycocotools writes."""
    letters: list[str] = []
    for i, run in enumerate(runs):
        value = run - runs[i - 2] if i > 2 else run
        more = True
        while more:
            group = value & 31
            value >>= 5
            more = value != (-1 if group & 16 else 0)
            letters.append(chr(48 + group + (32 if more else 0)))
    return "".join(letters)


def mask_of_runs(runs: list[int], height: int, width: int) -> np.ndarray:
    """Mask (height, width); ValueError unless the runs cover it exactly."""
    if any(run < 0 for run in runs) or sum(runs) != height * width:
        raise ValueError(f"run lengths do not fill {height} x {width} pixels")
    values = np.arange(len(runs)) % 2 == 1
    return np.repeat(values, runs).reshape(width, height).T


def runs_of_mask(mask: np.ndarray) -> list[int]:
    """Runs of a mask, without empty runs but the first."""
    flat = mask.T.ravel()
    changes = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    edges = np.concatenate(([0], changes, [flat.size]))
    runs = np.diff(edges).tolist()
    return [0, *runs] if flat.size and flat[0] else runs


def decode(segmentation: dict) -> np.ndarray:
    """Mask of {"size": [height, width], "counts": text or list of runs}."""
    height, width = segmentation["size"]
    counts = segmentation["counts"]
    runs = runs_of_text(counts) if isinstance(counts, str) else list(counts)
    return mask_of_runs(runs, height, width)


def encode(mask: np.ndarray) -> dict:
    """The mask as pycocotools would write it."""
    return {"size": list(mask.shape), "counts": text_of_runs(runs_of_mask(mask))}
