#!/usr/bin/python3
"""Where twin, Blender and exact arithmetic agree: makes results/stability/README.md, figures.json and the chart.

    tests/stability/stability.py [--report FOLDER] [--blender NAME]... [--only AXIS]
    tests/stability/stability.py [--report FOLDER] --draw

Runs build/release/tests/stability, which renders some 350 frames of 320 x 240 with each Blender. --only measures the axes
whose name contains AXIS and leaves the other figures as they are; --draw makes page and chart of the figures that there
are.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "tests" / "stability"
NOT_RELATIVE = "distance, not relative to the camera"  # shows what is not done
GAPS = "faces a gap apart"  # where rounding alone decides, which would drown all sums


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, default=HOME / "results" / "stability", help="the folder")
    parser.add_argument("--blender", action="append", help="as seedframe's --blender takes it")
    parser.add_argument("--only", default="", metavar="AXIS", help="measure the axes whose name contains this")
    parser.add_argument("--draw", action="store_true", help="measure nothing")
    options = parser.parse_args()
    options.report.mkdir(parents=True, exist_ok=True)
    figures = options.report / "figures.json"
    if not options.draw:
        blenders = options.blender or ["blender", f"python:{HOME}/venv/blender-4.5"]
        earlier = read_cases(figures) if options.only and figures.exists() else []
        cases = merged(earlier, measure(blenders, options.only))
        figures.write_text(json.dumps({"cases": cases}, indent=1) + "\n", encoding="utf-8")
    charts = [str(options.report / f"stability.{ending}") for ending in ("svg", "png")]
    subprocess.run([str(PROGRAM), "draw", str(figures), *charts], check=True)
    (options.report / "README.md").write_text(page(read_cases(figures)), encoding="utf-8")


def read_cases(figures):
    return json.loads(figures.read_text(encoding="utf-8"))["cases"]


def merged(earlier, measured):
    """Axes that were measured take the place of those of earlier, in the order of earlier."""
    axes = dict.fromkeys(case["axis"] for case in [*earlier, *measured])
    again = {case["axis"] for case in measured}
    cases = [*(case for case in earlier if case["axis"] not in again), *measured]
    return [case for axis in axes for case in cases if case["axis"] == axis]


def measure(blenders, only):
    with tempfile.TemporaryDirectory(prefix="seedframe-stability-") as folder:
        scripts = pathlib.Path(folder) / "scripts"
        shutil.copytree(HOME / "blender_scripts", scripts)
        move_the_world(scripts / "scene_builder.py")
        cases = []
        command = [str(PROGRAM), "measure", folder, only, *blenders]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                cases.append(json.loads(line))
                print(cases[-1]["axis"], cases[-1]["name"], file=sys.stderr)
        if process.returncode != 0:
            sys.exit(f"stability ended with {process.returncode}")
    return cases


def move_the_world(script):
    """Everything is a child of the camera; where that stands is where Blender's float32 coordinates begin."""
    text = script.read_text(encoding="utf-8")
    known = '        self._set_camera(spec["camera"], spec["render"])\n'
    assert text.count(known) == 1
    moved = known + '        self._camera.location = spec["stability_origin_m"]\n'
    script.write_text(text.replace(known, moved), encoding="utf-8")


# --- The page.

def page(cases):
    text = (HOME / "tests" / "stability" / "page.md").read_text(encoding="utf-8")
    frames = sum(case["frames"] for case in cases)
    return text.format(
        versions=" and ".join(blender["version"] for blender in cases[0]["blenders"]),
        frames=frames,
        cases=len(cases),
        summary=summary(cases),
        worst=worst_cases([case for case in cases if case["axis"] != NOT_RELATIVE]),
        tables="\n\n".join(tables(cases)),
        moved=moved(cases),
    )


def subjects(case):
    """What is compared with exact arithmetic: a name and its agreement, of the frames that there are."""
    yield "the twin", case["twin"]
    for blender in case["blenders"]:
        if not blender["failure"]:
            yield f"Blender {blender['version']}", blender["agreement"]


def summary(cases):
    """How often each is wrong, and who is right where they differ."""
    lines = ["| | pixels | wrong | differ from the twin | there the twin is right | it is right | neither | tie |",
             "|---|---:|---:|---:|---:|---:|---:|---:|"]
    kept = [case for case in cases if case["axis"] not in (NOT_RELATIVE, GAPS)]
    twin = [case["twin"] for case in kept]
    lines.append(f"| the twin | {total(twin, 'pixels'):,} | {total(twin, 'wrong'):,} | | | | | |")
    for index, blender in enumerate(kept[0]["blenders"]):
        of_it = [case["blenders"][index] for case in kept]
        agreements = [each["agreement"] for each in of_it]
        differ = total(of_it, "inside_px") + total(of_it, "edge_px")
        lines.append(
            f"| Blender {blender['version']} | {total(agreements, 'pixels'):,} | {total(agreements, 'wrong'):,} | {differ:,} | "
            f"{total(of_it, 'twin_right'):,} | {total(of_it, 'blender_right'):,} | {total(of_it, 'nobody_right'):,} | "
            f"{total(of_it, 'ties'):,} |")
    return "\n".join(lines)


def total(items, key):
    return sum(item[key] for item in items)


def worst_cases(cases):
    lines = ["| | most pixels wrong | largest depth error in 99 % of the pixels | largest normal error in 99 % |", "|---|---|---|---|"]
    found = {}
    for case in cases:
        for name, agreement in subjects(case):
            for key, value in (("wrong", agreement["wrong"] / max(1, agreement["pixels"])),
                               ("depth", agreement["depth_ulp"]["p99"]), ("normal", agreement["normal_deg"]["p99"])):
                if value > found.get((name, key), (-1,))[0]:
                    found[name, key] = (value, agreement, case)
    for name in dict.fromkeys(name for name, _ in found):
        wrong, depth, normal = (found[name, key] for key in ("wrong", "depth", "normal"))
        lines.append(f"| {name} | {100 * wrong[0]:.2g} %: {place(wrong[2])} | {short(depth[0])} ulp: {place(depth[2])} | "
                     f"{short(normal[0])}°: {place(normal[2])} |")
    return "\n".join(lines)


def place(case):
    return f"{case['axis']}, {case['name']}"


def tables(cases):
    for axis in dict.fromkeys(case["axis"] for case in cases):
        rows = [case for case in cases if case["axis"] == axis]
        versions = [blender["version"] for blender in rows[0]["blenders"]]
        names = " / ".join(["twin", *versions])
        heads = ["case", *(f"{version} differs" for version in versions), f"wrong: {names}", f"depth, ulp: {names}", f"normal, °: {names}"]
        yield "\n".join([f"### {axis[0].upper()}{axis[1:]}", "", "| " + " | ".join(heads) + " |",
                         "|---|" + "---:|" * (len(heads) - 1), *(row(case) for case in rows)])


def row(case):
    agreements = [case["twin"], *(blender["agreement"] if not blender["failure"] else None for blender in case["blenders"])]

    def each(value):
        return " / ".join("–" if agreement is None else value(agreement) for agreement in agreements)

    return "| " + " | ".join([
        case["name"],
        *(differences(blender) for blender in case["blenders"]),
        each(lambda agreement: f"{agreement['wrong']:,}"),
        each(lambda agreement: short(agreement["depth_ulp"]["p99"])),
        each(lambda agreement: short(agreement["normal_deg"]["p99"])),
    ]) + " |"


def differences(blender):
    if blender["failure"]:
        return "not rendered"
    refused = ", refused" if blender["complaint"] else ""
    return f"{blender['inside_px']:,} + {blender['edge_px']:,}{refused}"


def short(value):
    """Two digits are enough."""
    if value == 0:
        return "0"
    if value < 0.001 or value >= 1e6:
        mantissa, exponent = f"{value:.0e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def moved(cases):
    far = [case for case in cases if case["axis"] == cases[0]["axis"]]
    return ", ".join(f"{case['name']}: {case['twin_moved']}" for case in far)


if __name__ == "__main__":
    sys.exit(main())
