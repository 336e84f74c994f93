"""Compares every export of a campaign with its frames, and the exports with each other.

    agreement.py CAMPAIGN_DIR EXPORTS_DIR [--min-pixels N] [--min-visible F] [--amodal]
                 [--simplified]

EXPORTS_DIR holds folders named after their formats. Exit code 0: all equal, 1: something differs,
2: no known format.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

import bop
import check_bop
import check_coco
import check_others
import check_yolo
import coco
import compare
import patches
import source
import stats
import voc
import webdataset
import yolo
from common import Dataset
from compare import Report
from source import Campaign

FORMATS = (
    "coco",
    "coco-polygon",
    "coco-keypoints",
    "coco-panoptic",
    "yolo-detect",
    "yolo-segment",
    "yolo-obb",
    "yolo-pose",
    "voc",
    "bop",
    "webdataset",
    "patches",
    "statistics",
)
LOADERS: dict[str, Callable[[Path], Dataset]] = {
    "coco": coco.load,
    "voc": voc.load,
    "bop": bop.load,
    "webdataset": webdataset.load,
    "patches": patches.load,
    "statistics": stats.load,
}


def load(path: Path, campaign: Campaign) -> Dataset:
    """Decodes one export."""
    kind = path.name.split("-")[0]
    if kind == "yolo":
        sizes = {stem: (frame.width, frame.height) for stem, frame in campaign.frames.items()}
        return yolo.load(path, sizes)
    return LOADERS[kind](path)


def check(
    name: str,
    datasets: dict[str, Dataset],
    campaign: Campaign,
    report: Report,
    options: argparse.Namespace,
) -> None:
    """What is particular to the format."""
    dataset = datasets[name]
    splits = next(
        (d.splits for n, d in datasets.items() if n not in ("patches", "statistics")), None
    )
    if name not in ("patches", "statistics"):
        compare.compare_images(dataset, campaign, report)
    if name.startswith("coco"):
        check_coco.check(dataset, campaign, report, options.amodal, options.simplified)
    elif name.startswith("yolo"):
        check_yolo.check(dataset, campaign, report)
    elif name == "voc":
        check_others.check_voc(dataset, campaign, report)
    elif name == "bop":
        check_bop.check(dataset, campaign, report)
    elif name == "webdataset":
        check_others.check_webdataset(dataset, campaign, report, options.amodal)
    elif name == "patches":
        check_others.check_patches(dataset, campaign, report)
        if splits:
            check_others.check_patch_splits(dataset, splits, report)
    elif splits:
        check_others.check_statistics(dataset, campaign, splits, report)
    else:
        report.remarks.append("not compared: no other format says which images a split has")


def compare_all(
    campaign: Campaign, folder: Path, names: list[str], options: argparse.Namespace
) -> list[tuple[Report, str]]:
    """A report and a summary for each format; what cannot be read is a difference."""
    datasets: dict[str, Dataset] = {}
    reports = {name: Report(name) for name in names}
    for name in names:
        try:
            datasets[name] = load(folder / name, campaign)
        except Exception as error:  # whatever a parser throws at what it does not know
            reports[name].check(False, f"unreadable: {type(error).__name__}: {error}")
    for name, dataset in datasets.items():
        reports[name].differences += dataset.problems
        try:
            check(name, datasets, campaign, reports[name], options)
        except Exception as error:
            reports[name].check(False, f"cannot be checked: {type(error).__name__}: {error}")
    scenes = {}
    for dataset in datasets.values():
        for stem, scene in dataset.scenes.items():
            if scenes.setdefault(stem, scene) != scene:
                reports["webdataset"].check(False, f"{stem}: other scenes in BOP and WebDataset")
    for name, dataset in datasets.items():
        compare.compare_scenes(dataset, scenes, reports[name])
    compare.compare_splits(datasets, reports)
    compare.compare_contents(datasets, reports, compare.classes_of_assets(campaign), options.amodal)
    summaries = []
    for name, report in reports.items():
        dataset = datasets.get(name)
        if dataset is None:
            summary = "not read"
        elif name == "statistics":
            summary = f"statistics of {len(dataset.splits)} splits"
        else:
            images = sum(len(stems) for stems in dataset.splits.values())
            summary = f"{len(dataset.annotations)} annotations in {images} images"
        summaries.append((report, summary))
    return summaries


def main(arguments: list[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("campaign", type=Path)
    parser.add_argument("exports", type=Path)
    parser.add_argument("--min-pixels", type=int, default=1)
    parser.add_argument("--min-visible", type=float, default=0.0)
    parser.add_argument("--amodal", action="store_true")
    parser.add_argument("--simplified", action="store_true")
    options = parser.parse_args(arguments)
    names = [name for name in FORMATS if (options.exports / name).is_dir()]
    if not names:
        print(f"{options.exports}: no known format", file=sys.stderr)
        return 2
    campaign = source.read(
        options.campaign, options.min_pixels, options.min_visible, options.amodal
    )
    differs = False
    for report, summary in compare_all(campaign, options.exports, names, options):
        print("\n".join(report.lines(summary)))
        differs |= bool(report.differences)
    return int(differs)


if __name__ == "__main__":
    sys.exit(main())
