#!/usr/bin/python3
"""What the studies of paper 2 vary, measured in the labels of their configs: makes results/scenes/parts_<study>.md and .svg.

density    how much of an object is visible, over the number of objects on the same area (Figure 6)
curvature  how far apart the objects' heights are, and how much is visible, over the curvature of the ground (section 3.4)
cc_share   how many objects have a realistic material, over the share that was asked for (Figure 9)

Labels only: needs no Blender. The same figures each time.

    tests/bench/parts_study.py [STUDY…] [--program SEEDFRAME] [--report FOLDER]
"""

import argparse
import collections
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parents[2]
PLOT = {"left": 64, "top": 46, "width": 420, "height": 250}
SMALL = ("render.width=320", "render.height=240")
COLOURS = ("#c2410c", "#2563eb", "#15803d", "#6b21a8")


def frames_of(options, config, settings, folder):
    """(values of variables, labels, frame spec) of each frame of a config made with labels only."""
    command = [options.program, "submit", HOME / "configs" / config, "-o", folder / "campaign", "--quiet",
               "--set", "labels=geometry"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    command = [options.program, "check", HOME / "configs" / config, "--graphs", folder / "graphs.jsonl"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    lines = (folder / "graphs.jsonl").read_text(encoding="utf-8").splitlines()
    for index, line in enumerate(lines):
        frame = folder / "campaign" / "frames" / f"{index // 1000:03}" / f"{index:06}"
        yield (json.loads(line), json.loads((frame / "labels.json").read_text(encoding="utf-8")),
               json.loads((frame / "frame.json").read_text(encoding="utf-8")))


class Mean(tuple):
    """Mean and its standard error; frames are the sample, as objects of a frame hide each other."""
    count = 0


def mean_and_error(values):
    mean = Mean((statistics.mean(values), statistics.stdev(values) / math.sqrt(len(values))))
    mean.count = len(values)
    return mean


def counted(groups):
    return min(means[0].count for means in groups.values())


def visible_share(labels):
    """Mean over the target objects in view: visible pixels of those that the silhouette has in the image."""
    shares = [each["area_px"] / each["amodal"]["in_image_px"] for each in labels["instances"]
              if each["category"] > 0 and each["amodal"]["in_image_px"] > 0]
    return statistics.mean(shares) if shares else None


def mostly_hidden(labels):
    shares = [each["area_px"] / each["amodal"]["in_image_px"] for each in labels["instances"]
              if each["category"] > 0 and each["amodal"]["in_image_px"] > 0]
    return sum(share < 0.5 for share in shares) / len(shares) if shares else None


def grouped(frames, key, *measures):
    """By value of a variable: (mean, error) of each measure over its frames, in rising order."""
    found = collections.defaultdict(lambda: [[] for _ in measures])
    for values, labels, spec in frames:
        for own, measure in zip(found[round(values[key], 6)], measures):
            value = measure(values, labels, spec)
            if value is not None:
                own.append(value)
    return {value: [mean_and_error(each) for each in lists] for value, lists in sorted(found.items())}


def chart(title, x_title, y_title, series, most_x, most_y):
    """series: name to a list of (x, mean, error)."""
    left, top, width, height = PLOT["left"], PLOT["top"], PLOT["width"], PLOT["height"]

    def place(x, y):
        return left + width * x / most_x, top + height * (1.0 - y / most_y)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + width + 30} {top + height + 60}" '
             'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>',
             f'<text x="{left}" y="20" font-size="14">{title}</text>']
    for step in range(6):
        x, _ = place(most_x * step / 5, 0)
        _, y = place(0, most_y * step / 5)
        parts.append(f'<line x1="{left}" x2="{left + width}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                     f'<text x="{left - 8}" y="{y + 4:.1f}" text-anchor="end">{most_y * step / 5:.3g}</text>'
                     f'<text x="{x:.1f}" y="{top + height + 18}" text-anchor="middle">{most_x * step / 5:.3g}</text>')
    for number, (name, points) in enumerate(series.items()):
        colour = COLOURS[number]
        line = " ".join("{:.1f},{:.1f}".format(*place(x, mean)) for x, mean, _ in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for x, mean, error in points:
            (px, low), (_, high) = place(x, mean - error), place(x, mean + error)
            _, middle = place(x, mean)
            parts.append(f'<line x1="{px:.1f}" x2="{px:.1f}" y1="{low:.1f}" y2="{high:.1f}" stroke="{colour}"/>'
                         f'<circle cx="{px:.1f}" cy="{middle:.1f}" r="3" fill="{colour}"/>')
        parts.append(f'<text x="{left + 150 * number}" y="38" fill="{colour}">{name}</text>')
    parts.append(f'<text x="{left + width / 2}" y="{top + height + 42}" text-anchor="middle">{x_title}</text>'
                 f'<text transform="translate(16 {top + height / 2}) rotate(-90)" text-anchor="middle">{y_title}</text></svg>')
    return "\n".join(parts) + "\n"


def told(mean, error, digits=3):
    return f"{mean:.{digits}f} ± {error:.{digits}f}"


def density(options, folder):
    frames = frames_of(options, "parts_density.yaml", SMALL, folder)
    groups = grouped(frames, "n", lambda v, labels, s: visible_share(labels), lambda v, labels, s: mostly_hidden(labels),
                     lambda values, l, s: values["density"])
    lines = ["# Density and occlusion (Figure 6 of paper 2)", "",
             "`configs/parts_density.yaml`: so many objects dropped onto 1 m², "
             f"{counted(groups)} frames of each number. *Visible*: pixels of a "
             "target object over those of its whole silhouette in the image, mean over the objects in view. *Mostly hidden*: share "
             "of the target objects in view of which less than half is visible. ± is the standard error over frames.", "",
             "| objects | on a square metre | visible | mostly hidden |", "|---:|---:|---:|---:|"]
    lines += [f"| {n:.0f} | {per_area[0]:.0f} | **{told(*visible)}** | {told(*hidden)} |"
              for n, (visible, hidden, per_area) in groups.items()]
    shares = [visible[0] for visible, _, _ in groups.values()]
    falls = all(after < before for before, after in zip(shares, shares[1:]))
    lines += ["", f"The visible share {'falls with every step' if falls else 'DOES NOT FALL with every step'}. "
              "![visible share over the number of objects](parts_density.svg)"]
    series = {"visible": [(n, *visible) for n, (visible, _, _) in groups.items()],
              "mostly hidden": [(n, *hidden) for n, (_, hidden, _) in groups.items()]}
    return falls, lines, chart("Objects on 1 m²", "objects", "share", series, 400, 1.0)


def relief_cm(_, labels, spec):
    """Standard deviation of the objects' heights over the plane through the ground's middle, whose third axis points up."""
    pose = next(each for each in spec["instances"] if each["name"] == "ground")["camera_from_object"]
    heights = [100 * sum(pose[4 * row + 2] * (each["amodal"]["pose"]["translation_m"][row] - pose[4 * row + 3]) for row in range(3))
               for each in labels["instances"]]
    return statistics.pstdev(heights)


def curvature(options, folder):
    frames = frames_of(options, "parts_curvature.yaml", SMALL, folder)
    groups = grouped(frames, "a", relief_cm, lambda v, labels, s: visible_share(labels))
    lines = ["# Curvature of the ground (paper 2, section 3.4)", "",
             f"`configs/parts_curvature.yaml`, {counted(groups)} frames of each curvature: 199 objects on 1 m² of a ground z = a (x² + y²) / 2. "
             "*Relief*: standard deviation of the objects' heights, which piles have on a plane, too. *Visible*: as in "
             "[parts_density.md](parts_density.md). ± is the standard error over frames.", "",
             "| a, 1/m | relief, cm | visible |", "|---:|---:|---:|"]
    lines += [f"| {a:.3f} | **{told(*relief, 2)}** | {told(*visible)} |" for a, (relief, visible) in groups.items()]
    reliefs = [relief[0] for relief, _ in groups.values()]
    rises = all(after > before for before, after in zip(reliefs, reliefs[1:]))
    lines += ["", "![relief over curvature](parts_curvature.svg)"]
    series = {"relief": [(a, *relief) for a, (relief, _) in groups.items()]}
    most = math.ceil(max(reliefs) / 5) * 5
    return rises, lines, chart("Objects on curved ground", "a, 1/m", "standard deviation of heights, cm", series, 2.0, most)


def realistic_share(_, labels, spec):
    materials = spec["materials"]
    shown = [each for each in spec["instances"] if each["name"].split("/")[0] in ("pump_covers", "housing_caps", "distractors")]
    return statistics.mean(bool(materials[each["materials"][0]].get("textures")) for each in shown)


def cc_share(options, folder):
    frames = frames_of(options, "parts_cc_share.yaml", SMALL, folder)
    groups = grouped(frames, "cc_share", realistic_share)
    lines = ["# Share of realistic materials (Figure 9 of paper 2)", "",
             f"`configs/parts_cc_share.yaml`, {counted(groups)} frames of each share: 199 objects with a material each, a textured one with the "
             "probability that is asked for. *Found*: share of the objects whose material has textures. ± is the standard error "
             "over frames.", "", "| asked for | found |", "|---:|---:|"]
    lines += [f"| {share:.3f} | **{told(*found)}** |" for share, (found,) in groups.items()]
    near = all(abs(found[0] - share) <= 4 * found[1] + 1e-9 for share, (found,) in groups.items())
    lines += ["", "![found over asked for](parts_cc_share.svg)"]
    series = {"found": [(share, *found) for share, (found,) in groups.items()]}
    return near, lines, chart("Objects with a realistic material", "share asked for", "share found", series, 1.0, 1.0)


STUDIES = {"density": density, "curvature": curvature, "cc_share": cc_share}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", nargs="*", choices=[*STUDIES, []], default=[])
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, default=HOME / "results" / "scenes")
    options = parser.parse_args()
    code = 0
    for name in options.study or STUDIES:
        with tempfile.TemporaryDirectory(prefix="seedframe-study-") as folder:
            as_expected, lines, drawing = STUDIES[name](options, pathlib.Path(folder))
        text = "\n".join([lines[0], "", "Made by `tests/bench/parts_study.py`.", *lines[1:]]) + "\n"
        print(text)
        (options.report / f"parts_{name}.md").write_text(text, encoding="utf-8")
        (options.report / f"parts_{name}.svg").write_text(drawing, encoding="utf-8")
        if not as_expected:
            print(f"parts_study.py: {name} is not as it should be", file=sys.stderr)
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
