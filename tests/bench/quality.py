#!/usr/bin/python3
"""Is a stated error kept, and what does it save? Makes results/quality/quality.md.

A few frames of each scene are rendered with `quality` (nothing denoised, and denoised where that is cheaper), and
with fixed numbers of samples. `seedframe verify-error` then says how wrong each frame is. Of the fixed numbers, the
one whose 95th percentile of errors is that of the `quality` campaign is found between those that were rendered, by
straight lines over logarithms, and its CPU time with it.

    tests/bench/quality.py [--blender BLENDER] [--scene NAME…] [--report FILE] [--errors FILE]

Errors are the same whatever the machine is busy with, and take most of the time; times are not. With --errors, errors
that the file has are not measured again, and others are added to it: a second run of ten minutes, on a machine that
does nothing else, then measures times only.

CPU time is what workers of one thread took for the frames, from the job store. Pilots are told apart: they cost the
same for 24 frames as for 10,000.
"""

import argparse
import dataclasses
import json
import math
import os
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "seedframe"
FRAMES = 24
WIDTH, HEIGHT = 128, 96
REFERENCE = 128  # samples; the noise that is left of it is subtracted
FIXED = (8, 16, 32, 64, 128)
SHARE = 0.95


@dataclasses.dataclass
class Scene:
    name: str
    config: str
    bound: float  # rmse8
    size: tuple = ()  # settings that make FRAMES frames


SCENES = (
    Scene("demo", "parts.yaml", 5, ("scenes=6", "frames_per_scene=4")),
    Scene("RoboCup", "robocup_spl.yaml", 5, ("scenes=6", "frames_per_scene=4")),
    Scene("parts study", "parts_study.yaml", 6, ("scenes=6", "frames_per_scene=4")),
    Scene("3D-TYOL", "tyol_multi_8_target.yaml", 4, ("scenes=24",)),
)


@dataclasses.dataclass
class Rendered:
    cpu_s: float  # a frame
    percentile: float  # of the frames' errors
    within: int  # so many frames are within the bound
    scouts_s: float = 0.0  # a frame
    pilots_s: float = 0.0
    denoised: int = 0


class Bench:
    def __init__(self, blender, folder, errors):
        self.blender = blender
        self.folder = folder
        self.errors = errors

    def errors_of(self, scene, name, campaign):
        """The 95th percentile, and how many frames are within the bound."""
        key = f"{scene.name}, {name}"
        if key not in self.errors.known:
            answer = run([PROGRAM, "verify-error", campaign, "--frames", str(FRAMES), "--samples", str(REFERENCE),
                          "--quiet", "--json", "--blender", self.blender, "--workers", str(os.cpu_count()),
                          "--threads", "1"], (0, 10))
            errors = sorted(frame["rmse8"] for frame in json.loads(answer.stdout)["frames"])
            self.errors.keep(key, {"percentile": round(errors[math.ceil(SHARE * len(errors)) - 1], 4),
                                   "within": sum(each <= scene.bound for each in errors)})
        return self.errors.known[key]

    def render(self, scene, name, settings):
        campaign = self.folder / f"{scene.name}-{name}".replace(" ", "-")
        command = [PROGRAM, "submit", HOME / "configs" / scene.config, "-o", campaign, "--quiet", "--blender", self.blender,
                   "--workers", str(os.cpu_count()), "--threads", "1"]
        if "quality" in name:
            command.remove("--quiet")
        for setting in (*scene.size, f"render.width={WIDTH}", f"render.height={HEIGHT}", "render.passes=[]", *settings):
            command += ["--set", setting]
        told = run(command).stderr
        with sqlite3.connect(campaign / "campaign.sqlite") as store:
            seconds, = store.execute("SELECT sum(build_s + render_s) FROM attempts WHERE outcome = 'done'").fetchone()
        rendered = Rendered(seconds / FRAMES, **self.errors_of(scene, name, campaign))
        calibrated = re.search(r"pilots ([\d.]+), scouts ([\d.]+) CPU s", told)
        if calibrated:
            rendered.pilots_s = float(calibrated[1])
            rendered.scouts_s = float(calibrated[2]) / FRAMES
            denoised = re.search(r"(\d+) frames denoised", told)
            rendered.denoised = int(denoised[1]) if denoised else 0
        print(f"{scene.name}, {name}: {rendered.cpu_s:.3f} CPU s a frame, 95 % within {rendered.percentile:.2f}",
              file=sys.stderr, flush=True)
        return rendered


class Errors:
    def __init__(self, file):
        self._file = file
        self.known = json.loads(file.read_text()) if file and file.exists() else {}

    def keep(self, key, value):
        self.known[key] = value
        if self._file:
            self._file.write_text(json.dumps(self.known, indent=2) + "\n")


def run(command, codes=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          env={**os.environ, "SEEDFRAME_CACHE": "off"})
    if done.returncode not in codes:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr}")
    return done


def fixed_at(error, fixed):
    """Samples and CPU seconds of the fixed number whose 95th percentile is that; beyond the ends as the last piece."""
    points = sorted((math.log(each.percentile), math.log(samples), math.log(each.cpu_s))
                    for samples, each in fixed.items())
    at = math.log(error)
    upper = next((i for i in range(1, len(points)) if points[i][0] >= at), len(points) - 1)
    (e0, n0, c0), (e1, n1, c1) = points[upper - 1], points[upper]
    share = (at - e0) / (e1 - e0)
    return math.exp(n0 + share * (n1 - n0)), math.exp(c0 + share * (c1 - c0))


def interval(within, of):
    """Wilson's, 95 %."""
    z = 1.959964
    p = within / of
    center = (p + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    return max(0, center - half), min(1, center + half)


def row(scene, kind, rendered, fixed):
    error = rendered.percentile
    samples, seconds = fixed_at(error, fixed)
    within = rendered.within
    low, high = interval(within, FRAMES)
    frame = rendered.cpu_s + rendered.scouts_s
    return (f"| {scene.name} | {kind}{f', {rendered.denoised} frames' if rendered.denoised else ''} | {scene.bound} | "
            f"{100 * within / FRAMES:.0f} % ({100 * low:.0f} to {100 * high:.0f}) | {error:.2f} | {rendered.cpu_s:.3f} + "
            f"{rendered.scouts_s:.3f} | {rendered.pilots_s:.0f} | {samples:.0f} samples, {seconds:.3f} | "
            f"**{frame / seconds:.2f}** ({rendered.cpu_s / seconds:.2f} without scouts) |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blender", default="python:" + str(HOME / "venv" / "blender-4.5"))
    parser.add_argument("--scene", action="append", choices=[scene.name for scene in SCENES])
    parser.add_argument("--errors", type=pathlib.Path, help="what is known of them; see above")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    rows = []
    errors = Errors(options.errors)
    version = run([PROGRAM, "--version"]).stdout.strip()
    for scene in SCENES:
        if options.scene and scene.name not in options.scene:
            continue
        with tempfile.TemporaryDirectory(prefix="seedframe-quality-") as folder:
            bench = Bench(options.blender, pathlib.Path(folder), errors)
            wish = f"{{metric: rmse8, max_error: {scene.bound}, share: {SHARE}"
            fixed = {samples: bench.render(scene, f"{samples} samples", [f"render.samples={samples}"])
                     for samples in FIXED}
            exact = bench.render(scene, "quality", ["render.samples=512", f"quality={wish}}}"])
            denoised = bench.render(scene, "quality, denoised", ["render.samples=512", f"quality={wish}, denoise: auto}}"])
        rows += [row(scene, "off", exact, fixed), row(scene, "auto", denoised, fixed)]
        text = page(rows, version, options.blender)
        if options.report:  # after each scene: they take minutes
            options.report.parent.mkdir(parents=True, exist_ok=True)
            options.report.write_text(text, encoding="utf-8")
    print(text)


def page(rows, version, blender):
    name = pathlib.Path(blender).name
    return "\n".join([
        "# A stated error: kept, and what it saves", "",
        f"Made by `scripts/bench.sh quality` (`tests/bench/quality.py`): {version}, Blender {name}, {os.cpu_count()} cores.",
        f"{FRAMES} frames of {WIDTH} × {HEIGHT} of each scene; a share of {SHARE} of them is to be within the bound, in RMSE of",
        "8-bit codes. The fixed number of samples is the one with the same 95th percentile of errors. CPU seconds of a",
        "frame are of its rendering and of its two scouts; pilots are rendered once, however many frames there are.", "",
        "| scene | denoise | bound | frames within (95 % confidence) | 95th percentile | CPU s a frame, + scouts | pilots, CPU s | "
        "fixed with the same percentile, CPU s | CPU time / fixed |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|", *rows, ""])


if __name__ == "__main__":
    main()
