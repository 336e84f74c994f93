#!/usr/bin/python3
"""How does the cost of a frame grow with what is in it? Makes results/scaling/README.md and a chart.

One thing is varied at a time: objects, triangles, lights, textures, resolution, workers, and frames of a campaign.
Each point is a small campaign with everything that is on by default; what a frame took is read from its job store,
the first frame of each worker apart, which reads meshes and images.

    tests/bench/scaling.py [--axis NAME…] [--blender BLENDER] [--largest-mesh 1000000] [--report FOLDER]
    tests/bench/scaling.py --draw results/scaling      the chart again, of figures that are there
"""

import argparse
import contextlib
import dataclasses
import json
import math
import os
import pathlib
import sqlite3
import statistics
import struct
import subprocess
import sys
import tempfile
import time

from overhead import version_of

HOME = pathlib.Path(__file__).resolve().parents[2]
FRAMES = 5  # of a point; the first is the warm-up

SCENE = """
seedframe: 1
name: scaling
scenes: {frames}
categories: [thing]
{folders}
render: {{width: {width}, height: {height}, samples: {samples}, max_bounces: 4}}
{labels}
objects:
  things:
    asset: {asset}
    category: thing
    grid: {{counts: [{columns}, {rows}, 1], spacing_m: [0.06, 0.06, 0.06]}}
    rotation_deg: [0, 0, {{uniform: [0, 360]}}]
    scale: {scale}
    material: {material}
ground: {{width_m: 6, depth_m: 6, material: plain_grey}}
lights:
{lights}
camera: {{fov_deg: 50, target: [0, 0, 0], distance_m: {distance}, elevation_deg: 60, azimuth_deg: {{uniform: [0, 360]}}}}
"""


@dataclasses.dataclass
class Point:
    axis: str
    value: int
    settings: dict
    workers: int = 1
    threads: int = 2


@dataclasses.dataclass
class Cost:
    point: Point
    build_ms: float   # of a frame: the scene in Blender
    render_ms: float  # Cycles, and writing the EXR
    finish_ms: float  # checks, twin, colour, labels, files
    expand_ms: float  # of a frame, from the config to its spec, with the id
    wall_ms: float    # of a frame, all told, workers beside each other


def scene(**changes):
    values = dict(frames=FRAMES, width=320, height=240, samples=1, labels="", asset="hex_nut", count=25, scale=1,
                  material="steel", light_count=1, folders="")
    values.update(changes)
    columns = math.ceil(math.sqrt(values["count"]))
    values["columns"], values["rows"] = columns, math.ceil(values["count"] / columns)
    values["distance"] = max(0.5, 0.075 * columns)
    side = math.ceil(math.sqrt(values["light_count"]))
    values["lights"] = "\n".join(
        f"  lamp{i}: {{type: point, position: [{0.4 * (i % side) - 0.2 * side:.2f}, {0.4 * (i // side) - 0.2 * side:.2f}, 1], "
        f"power: {20 / values['light_count']:.4f}}}" for i in range(values["light_count"]))
    return SCENE.format(**values)


def points(largest_mesh):
    yield from (Point("objects", n, {"count": n}) for n in (1, 10, 100, 1000))
    triangles = [n for n in (1_000, 10_000, 100_000, 1_000_000, 3_900_000) if n <= largest_mesh]
    yield from (Point("triangles", n, {"count": 1, "asset": f"bumpy_{n}"}) for n in triangles)
    yield from (Point("lights", n, {"light_count": n, "samples": 4}) for n in (1, 10, 100))
    yield from (Point("textures", n, {"count": 100, "material": textured(n)}) for n in (0, 1, 10, 100))
    for width, height in ((64, 64), (256, 256), (1024, 1024), (3840, 2160)):
        yield Point("pixels", width * height, {"width": width, "height": height})
    yield from (Point("workers", n, {"width": 128, "height": 128, "frames": 40}, n, 1) for n in (1, 2))
    tiny = {"width": 64, "height": 64, "count": 4, "labels": "labels: geometry"}
    yield from (Point("frames", n, {**tiny, "frames": n}, 2, 1) for n in (10, 100, 1000, 10_000))


def textured(count):
    if count == 0:
        return "steel"
    return "{choice: [" + ", ".join(f"tile{i}" for i in range(count)) + "]}"


def write_bumpy_ball(path, triangles):
    """A binary STL of a ball of 25 mm with bumps, so that no coarser level is like it."""
    import numpy  # late: --help needs none

    rows = max(3, round(math.sqrt(triangles / 4)))
    columns = 2 * rows
    polar = numpy.linspace(0, math.pi, rows + 1)[:, None]
    around = numpy.linspace(0, 2 * math.pi, columns, endpoint=False)[None, :]
    radius = 0.025 * (1 + 0.05 * numpy.sin(40 * polar) * numpy.sin(40 * around))
    position = numpy.stack(numpy.broadcast_arrays(radius * numpy.sin(polar) * numpy.cos(around),
                                                  radius * numpy.sin(polar) * numpy.sin(around),
                                                  radius * numpy.cos(polar) + 0 * around), -1)
    position[0], position[-1] = (0, 0, 0.025), (0, 0, -0.025)
    i, j = numpy.meshgrid(numpy.arange(rows), numpy.arange(columns), indexing="ij")
    next_j = (j + 1) % columns
    a, b = position[i, j], position[i, next_j]
    c, d = position[i + 1, next_j], position[i + 1, j]
    lower = numpy.stack([a, d, c], 2)[:-1].reshape(-1, 3, 3)  # the last row's have no area, as
    upper = numpy.stack([a, c, b], 2)[1:].reshape(-1, 3, 3)   # the first row's others
    faces = numpy.concatenate([lower, upper])
    record = numpy.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    record["corners"] = faces
    with path.open("wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(faces)))
        file.write(record.tobytes())


def write_tiles(folder, count):
    """Texture sets of one image each, all different, and materials of the same names."""
    from PIL import Image

    lines = ["materials:"]
    for i in range(count):
        home = folder / "textures" / f"Tile{i}"
        home.mkdir(parents=True)
        image = Image.effect_noise((256, 256), 40 + i % 60).convert("RGB")
        image.save(home / f"Tile{i}_Color.png")
        lines.append(f"  tile{i}: {{textures: Tile{i}}}")
    (folder / "library.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def measure(options, point, folder):
    assets, materials = folder / "assets", folder / "materials"
    config = folder / "config.yaml"
    folders = f"asset_folders: [{assets}]\nmaterial_folders: [{materials}]"
    config.write_text(scene(**{**point.settings, "folders": folders}), encoding="utf-8")
    campaign = folder / f"{point.axis}-{point.value}"
    environment = {**os.environ, "SEEDFRAME_CACHE": "off"}
    begin = time.monotonic()
    subprocess.run([options.program, "check", config], check=True, env=environment, stdout=subprocess.DEVNULL)
    expand_s = time.monotonic() - begin
    subprocess.run([options.program, "submit", config, "-o", campaign, "--quiet", "--blender", options.blender,
                    "--workers", str(point.workers), "--threads", str(point.threads)],
                   check=True, env=environment, stdout=subprocess.DEVNULL)
    with contextlib.closing(sqlite3.connect(campaign / "campaign.sqlite")) as store:
        rows = store.execute("SELECT worker, started, build_s, render_s, finish_s FROM attempts ORDER BY started").fetchall()
    frames = point.settings.get("frames", FRAMES)
    warm = rows[point.workers:]
    # From the first frame's start to the last one's end, but for what workers read first.
    wall_s = (warm[-1][1] + sum(warm[-1][2:]) - warm[0][1]) / len(warm)
    mean = lambda column: 1e3 * statistics.mean(row[column] for row in warm)
    cost = Cost(point, mean(2), mean(3), mean(4), 1e3 * expand_s / frames, 1e3 * wall_s)
    print(cost, file=sys.stderr, flush=True)
    return cost


def growth(costs, cost_of):
    """The exponents between neighbours: 1 is linear, 0 no growth."""
    told = []
    for a, b in zip(costs, costs[1:]):
        if a.point.value == 0 or cost_of(a) <= 0:
            continue
        told.append(math.log(cost_of(b) / cost_of(a)) / math.log(b.point.value / a.point.value))
    return told


PANEL = (300, 220)
LEAST_MS = 0.1  # that is drawn
LINES = (("all told, wall", "wall_ms", "#222222"), ("Cycles", "render_ms", "#c2410c"), ("build", "build_ms", "#2563eb"),
         ("finish", "finish_ms", "#15803d"))


def chart(costs):
    """Milliseconds of a frame against each axis, both logarithmic, a panel each, as SVG."""
    axes = list(dict.fromkeys(cost.point.axis for cost in costs))
    shown = [[max(getattr(cost, key), LEAST_MS) for cost in costs if cost.point.axis == axis] for axis in axes
             for _, key, _ in LINES]
    low = math.floor(math.log10(min(map(min, shown))))
    high = math.ceil(math.log10(max(map(max, shown))))
    columns = 4
    rows = math.ceil(len(axes) / columns)
    width, height = columns * PANEL[0] + 20, rows * PANEL[1] + 60
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
             f'font-size="12"><rect width="{width}" height="{height}" fill="white"/>',
             '<text x="20" y="24" font-size="15">Milliseconds of a frame</text>']
    for i, (name, _, colour) in enumerate(LINES):
        parts.append(f'<line x1="{220 + 130 * i}" x2="{245 + 130 * i}" y1="20" y2="20" stroke="{colour}" stroke-width="2.5"/>'
                     f'<text x="{250 + 130 * i}" y="24">{name}</text>')
    for i, axis in enumerate(axes):
        own = [cost for cost in costs if cost.point.axis == axis]
        parts += panel(axis, own, low, high, 20 + i % columns * PANEL[0], 45 + i // columns * PANEL[1])
    return "\n".join([*parts, "</svg>\n"])


def panel(axis, costs, low, high, left, top):
    inner = (left + 40, top + 24, PANEL[0] - 65, PANEL[1] - 66)
    values = [max(cost.point.value, 0.5) for cost in costs]  # where 0 stands
    first, last = math.log10(values[0]), math.log10(values[-1])
    x_of = lambda value: inner[0] + inner[2] * (math.log10(value) - first) / (last - first or 1)
    y_of = lambda ms: inner[1] + inner[3] * (high - math.log10(max(ms, LEAST_MS))) / (high - low)
    parts = [f'<text x="{inner[0]}" y="{top + 14}" font-weight="bold">{axis}</text>']
    for power in range(low, high + 1):
        y = y_of(10.0 ** power)
        parts.append(f'<line x1="{inner[0]}" x2="{inner[0] + inner[2]}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                     f'<text x="{inner[0] - 6}" y="{y + 4:.1f}" text-anchor="end" fill="#555">{10.0 ** power:g}</text>')
    for value, cost in zip(values, costs):
        parts.append(f'<text x="{x_of(value):.1f}" y="{inner[1] + inner[3] + 18}" text-anchor="middle" fill="#555">'
                     f'{short(cost.point.value)}</text>')
    for _, key, colour in LINES:
        line = [(x_of(value), y_of(getattr(cost, key))) for value, cost in zip(values, costs) if getattr(cost, key) > 0]
        if not line:
            continue
        parts.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in line)}" fill="none" stroke="{colour}" '
                     f'stroke-width="2"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in line]
    return parts


def short(number):
    for unit, letter in ((1_000_000, "M"), (1000, "k")):
        if number >= unit:
            return f"{number / unit:.3g} {letter}"
    return str(number)


# Where growth is not linear, and why: of code and method, so it holds for other figures too.
READING = {
    "objects": "Up to some hundred, what a frame costs anyway hides them: Cycles' start, its BVH of the ground, reading and checking "
               "the picture. Beyond, each object costs Cycles a transform, its attributes and a place in the upper BVH, and the "
               "twin a silhouette of its own pixels: towards linear.",
    "triangles": "A worker reads a mesh once, so building does not grow. Without persistent data Cycles keeps nothing between "
                 "frames: normals and BVH of each mesh are made anew in every frame, which is linear, and nearly all of a frame "
                 "from a million on. Expansion reads and decodes the asset, once a campaign.",
    "lights": "Less than linear: a path asks one light at a time, whatever their number; what grows is the choice.",
    "textures": "Cycles loads the images of a frame anew, and one material switches between all sets of a mesh: linear in the "
                "sets that a frame wears. Making a tree of nodes costs the square of its size, since Blender updates all of it "
                "with each node; so trees are kept, in round sizes, and the build column has the share of those that were made "
                "within these few frames.",
    "pixels": "Linear from some 65,000 on; below, what a frame costs anyway shows.",
    "workers": "Two workers of one thread share caches and memory, and Seedframe's own threads run beside them: not twice as fast.",
    "frames": "What a frame costs does not depend on their number; ten are too few to keep two threads busy to the end.",
}


def report(options, costs):
    lines = ["# How costs grow", "",
             "Made by `scripts/bench.sh scaling`; `tests/bench/scaling.py` says how. Milliseconds of a frame, the mean of "
             f"{FRAMES - 1} after a worker's first, {version_of(options.blender)}, {os.cpu_count()} cores, one worker with "
             "two threads unless said otherwise. *Growth*: the exponent from the point before; 1 is linear.", "",
             "![milliseconds of a frame against each](scaling.svg)", ""]
    unlike = {"workers": "40 frames of 128 × 128; one thread each", "lights": "4 samples", "pixels": "25 objects",
              "textures": "100 objects, images of 256 × 256", "triangles": "one object, one mesh",
              "objects": "of one mesh with some 1,200 triangles", "frames": "64 × 64, `labels: geometry`, two at once"}
    for axis in dict.fromkeys(cost.point.axis for cost in costs):
        own = [cost for cost in costs if cost.point.axis == axis]
        lines += [f"## {axis.capitalize()}", "", f"{unlike[axis][0].upper()}{unlike[axis][1:]}.", "",
                  f"| {axis} | build | Cycles | finish | expansion | all told, wall | growth |", "|---:|---:|---:|---:|---:|---:|---:|"]
        exponents = growth(own, lambda cost: cost.wall_ms)
        exponents = [None] * (len(own) - len(exponents)) + exponents
        for cost, exponent in zip(own, exponents):
            lines.append(f"| {cost.point.value:,} | {cost.build_ms:.1f} | {cost.render_ms:.1f} | {cost.finish_ms:.1f} | "
                         f"{cost.expand_ms:.1f} | **{cost.wall_ms:.1f}** | {'' if exponent is None else f'{exponent:.2f}'} |")
        lines += ["", READING[axis], ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--axis", action="append", help="measure this one only")
    parser.add_argument("--blender", default=f"python:{HOME}/venv/blender-4.5")
    parser.add_argument("--largest-mesh", type=int, default=1_000_000, help="triangles; an import takes 4 million")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="folder for README.md and figures.json")
    parser.add_argument("--draw", type=pathlib.Path, help="measure nothing: draw this folder's figures.json again")
    options = parser.parse_args()
    if options.draw:
        costs = known_costs(options.draw)
        (options.draw / "scaling.svg").write_text(chart(costs), encoding="utf-8")
        return
    with tempfile.TemporaryDirectory(prefix="seedframe-scaling-") as name:
        folder = pathlib.Path(name)
        write_tiles(folder / "materials", 100)
        (folder / "assets").mkdir()
        costs = []
        for point in points(options.largest_mesh):
            if options.axis and point.axis not in options.axis:
                continue
            if point.axis == "triangles":
                mesh = folder / f"{point.settings['asset']}.stl"
                write_bumpy_ball(mesh, point.value)
                subprocess.run([options.program, "asset", "import", mesh, "--root", folder / "assets", "--levels", "0",
                                "--smooth-angle", "60"], check=True, stdout=subprocess.DEVNULL)
                mesh.unlink()
            costs.append(measure(options, point, folder))
    if options.axis and options.report:  # what was not measured is as it was
        costs += [cost for cost in known_costs(options.report) if cost.point.axis not in options.axis]
        order = list(dict.fromkeys(point.axis for point in points(options.largest_mesh)))
        costs.sort(key=lambda cost: order.index(cost.point.axis))
    text = report(options, costs)
    print(text)
    if options.report:
        options.report.mkdir(parents=True, exist_ok=True)
        (options.report / "README.md").write_text(text, encoding="utf-8")
        (options.report / "scaling.svg").write_text(chart(costs), encoding="utf-8")
        figures = [{"axis": cost.point.axis, "value": cost.point.value,
                    **{key: value for key, value in dataclasses.asdict(cost).items() if key != "point"}} for cost in costs]
        (options.report / "figures.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def known_costs(folder):
    """Of an earlier run."""
    file = folder / "figures.json"
    figures = json.loads(file.read_text(encoding="utf-8")) if file.exists() else []
    return [Cost(Point(figure.pop("axis"), figure.pop("value"), {}), **figure) for figure in figures]


if __name__ == "__main__":
    sys.exit(main())
