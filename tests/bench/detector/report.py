"""The study's tables, its chart, and a sheet of one frame with each setting."""

import json
import math
import os
import pathlib

import matplotlib
import numpy
import torch
from PIL import Image, ImageDraw

from campaigns import LEAST_PIXELS, LEAST_VISIBLE, run

NAMES = {"ap": "AP", "ap50": "AP at IoU 0.5", "top1": "top-1"}
COLORS = {False: "#1f77b4", True: "#ff7f0e"}
CPU_TICKS_S = (0.2, 0.5, 1, 2, 5)
SHEET_SCALE = 2


def write_report(folder, study, campaigns, figures, datasets):
    text = page(study, campaigns, figures)
    print(text)
    if not folder:
        return
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "study.md").write_text(text, encoding="utf-8")
    (folder / "study.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    chart(figures, folder / "study")
    sheet(datasets, folder / "frames.png")


def page(study, campaigns, figures):
    trainings = sorted({len(each["scores"]["ap"]) for each in figures["datasets"]})
    test = figures["test"]
    lines = [
        "# Samples against accuracy", "",
        f"Made by `tests/bench/detector/study.py`: {run([campaigns.program, '--version']).strip()}, Blender "
        f"{pathlib.Path(campaigns.blender).name},",
        f"torch {torch.__version__}, {os.cpu_count()} cores. Frames of 128 × 96, each of a scene of its own; objects of at "
        f"least {LEAST_PIXELS} visible",
        f"pixels and {100 * LEAST_VISIBLE:.0f} % of their silhouette. {' or '.join(map(str, trainings))} "
        f"training{'s' if trainings[-1] > 1 else ''} with each dataset, of {study.detector_steps} steps (detector) and "
        f"{study.classifier_steps} (classifier),",
        f"tested on {test['frames']} frames with {test['objects']} objects, of other scenes, rendered with up to "
        f"{study.test.samples} samples (adaptive, {study.test.threshold}).",
        "Accuracies in percent, the mean over trainings ± their standard deviation. *Against* is the difference from the",
        "table's first row ± two standard errors, of trainings and of test frames: what is less than that is not visible.", "",
        "![Accuracy over samples, over CPU time of a frame, and over samples at the same CPU time](study.svg)", "",
        "## The same scenes", "", f"{study.frames} frames each.", "", *table(figures, "same_scenes"), "",
        "## The same CPU time", "",
        f"As many frames as cost what {study.budget_frames} frames of {study.settings[0].samples} samples do; of settings that "
        f"were not rendered for so long, the {study.frames}", "frames from above where they cost less.", "",
        *table(figures, "same_time"), "",
        "## The noise of the experiment", ""]
    if trainings[-1] > 1:
        spread = figures["spread_of_seeds"]
        lines.append("Standard deviation between trainings with the same frames, from all datasets: " +
                     ", ".join(f"{NAMES[metric]} {spread[metric]:.1f}" for metric in NAMES) + ".")
    else:
        lines.append("A single training tells nothing of it: *against* has the noise of the test frames alone.")
    lines += [f"CPU seconds are of `submit` with all its children, less {figures['startup_cpu_s']:.1f} s for its start.", ""]
    return "\n".join(lines)


def rows_of(figures, comparison):
    rows = [each for each in figures["datasets"] if comparison in each["against"]]
    return sorted(rows, key=lambda each: (each["denoised"], -each["samples"]))


def table(figures, comparison):
    rows = rows_of(figures, comparison)
    lines = ["| samples | denoised | frames | objects | CPU s a frame | CPU s | " + " | ".join(
                 f"{name} | against" for name in NAMES.values()) + " |",
             "|---:|---|---:|---:|---:|---:|" + "---:|---:|" * len(NAMES)]
    for row in rows:
        cells = [row["samples"], "yes" if row["denoised"] else "", row["frames"], row["objects"],
                 f"{row['cpu_s'] / row['frames']:.3f}", f"{row['cpu_s']:.0f}"]
        for metric in NAMES:
            scores = row["scores"][metric]
            cells.append(f"{numpy.mean(scores):.1f}" + (f" ± {numpy.std(scores, ddof=1):.1f}" if len(scores) > 1 else ""))
            difference, error = row["against"][comparison][metric]
            cells.append("" if row is rows[0] else f"{difference:+.1f} ± {2 * error:.1f}")
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return lines


def chart(figures, path):
    """As SVG and PNG: of AP and of top-1 three charts each, with the spread over trainings."""
    matplotlib.use("agg")
    matplotlib.rcParams.update({"svg.hashsalt": "seedframe", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3})
    from matplotlib import pyplot  # after use()
    drawing, axes = pyplot.subplots(2, 3, figsize=(11, 6.2), sharey="row")
    for row, metric in enumerate(("ap", "top1")):
        for column, (title, comparison, across) in enumerate((
                ("the same scenes", "same_scenes", lambda each: each["samples"]),
                ("the same scenes", "same_scenes", lambda each: each["cpu_s"] / each["frames"]),
                ("at most the same CPU time", "same_time", lambda each: each["samples"]))):
            axis = axes[row][column]
            for denoised in (False, True):
                chosen = [each for each in rows_of(figures, comparison) if each["denoised"] == denoised]
                curve(axis, chosen, across, metric, label_frames=column == 2 and row == 0)
            axis.set_xscale("log")
            axis.set_xlabel("CPU s a frame" if column == 1 else "samples")
            axis.set_xticks(sorted({each["samples"] for each in figures["datasets"]}) if column != 1 else CPU_TICKS_S)
            axis.xaxis.set_major_formatter(matplotlib.ticker.ScalarFormatter())
            axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
            axis.margins(x=0.2, y=0.12)
            if row == 0:
                axis.set_title(title, fontsize=9)
            if column == 0:
                axis.set_ylabel(f"{'detector' if metric == 'ap' else 'classifier'}: {NAMES[metric]}, %")
    axes[0][0].legend()
    drawing.tight_layout()
    drawing.savefig(path.with_suffix(".svg"), metadata={"Date": None})
    drawing.savefig(path.with_suffix(".png"), dpi=110, metadata={"Software": None})


def curve(axis, chosen, across, metric, label_frames):
    if not chosen:
        return
    denoised = chosen[0]["denoised"]
    means = [numpy.mean(each["scores"][metric]) for each in chosen]
    spreads = [numpy.std(each["scores"][metric], ddof=1) if len(each["scores"][metric]) > 1 else math.nan for each in chosen]
    axis.errorbar([across(each) for each in chosen], means, spreads, color=COLORS[denoised], marker="os"[denoised],
                  markersize=4, capsize=3, linewidth=1.2, label="denoised" if denoised else "plain")
    for each, mean in zip(chosen, means):
        if label_frames:
            axis.annotate(f"{each['frames']} frames", (across(each), mean), xytext=(4, 6 if denoised else -12),
                          textcoords="offset points", fontsize=7, color=COLORS[denoised])


def sheet(datasets, path, frame=0):
    """One frame of the training scenes with each setting, and one of the test's."""
    tiles = list(datasets.items())
    height, width, _ = tiles[0][1].images[frame].shape
    width, height = SHEET_SCALE * width, SHEET_SCALE * height
    columns = (len(tiles) + 1) // 2
    drawn = Image.new("RGB", (columns * (width + 6) + 6, 2 * (height + 22) + 6), "white")
    pen = ImageDraw.Draw(drawn)
    for index, (name, dataset) in enumerate(tiles):
        x, y = 6 + index % columns * (width + 6), 20 + index // columns * (height + 22)
        drawn.paste(Image.fromarray(dataset.images[frame]).resize((width, height), Image.Resampling.NEAREST), (x, y))
        samples, _, denoised = name.partition("-")
        told = "a test frame" if name == "test" else f"samples: {samples}{denoised and ', denoised'}"
        pen.text((x, y - 14), told, fill="black")
    drawn.save(path)
