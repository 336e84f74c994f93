#!/usr/bin/python3
"""What does a picture of one object cost: cut out of whole images, cut out of the region around the objects, or rendered
at its own scale?

The same scenes three ways, as many frames each, in turns: whole images, `render.region: objects`, and `patches`. Cost is
what workers took for their frames, but for the first of each, over the pictures that `export --format patches` makes.

    tests/bench/patches.py [--config configs/robocup_spl.yaml] [--frames 12] [--rounds 3] [--blender BLENDER] [--report FILE]
"""

import argparse
import contextlib
import os
import pathlib
import sqlite3
import statistics
import subprocess
import sys
import tempfile

from overhead import version_of

HOME = pathlib.Path(__file__).resolve().parents[2]
WAYS = (("whole images", ()), ("`render.region: objects`", ("render.region=objects",)),
        ("`patches: {size: 32}`", ("patches.size=32",)))


def measure(options, settings, folder):
    """Seconds of a worker for a frame, its own share of it, and pictures of objects per frame."""
    environment = {**os.environ, "SEEDFRAME_CACHE": "off"}
    with tempfile.TemporaryDirectory(dir=folder) as name:
        campaign = pathlib.Path(name) / "campaign"
        command = [options.program, "submit", options.config, "-o", campaign, "--quiet", "--frames", str(options.frames),
                   "--blender", options.blender, "--workers", "2", "--threads", "1"]
        for setting in (f"render.samples={options.samples}", *settings):
            command += ["--set", setting]
        subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
        subprocess.run([options.program, "export", campaign, "--partial", "--format", "patches", "-o", campaign / "out"],
                       check=True, stdout=subprocess.DEVNULL)
        pictures = sum(1 for _ in (campaign / "out" / "patches").glob("*/*/*.png"))
        with contextlib.closing(sqlite3.connect(campaign / "campaign.sqlite")) as store:
            rows = store.execute("SELECT build_s + render_s, finish_s FROM attempts ORDER BY started").fetchall()[2:]
    return statistics.mean(row[0] for row in rows), statistics.mean(row[1] for row in rows), pictures / options.frames


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--config", action="append", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--blender", default=f"python:{HOME}/venv/blender-4.5")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    configs = options.config or [HOME / "configs" / name for name in ("robocup_spl.yaml", "parts.yaml")]
    lines = ["# Pictures of single objects", "",
             "Made by `scripts/bench.sh patches`; `tests/bench/patches.py` says how. "
             f"{options.frames} frames a round, {options.samples} samples, {version_of(options.blender)}, two workers of one "
             f"thread; medians of {options.rounds} rounds in turns. *A picture*: worker's time of a frame over the pictures that it "
             "gives. *25,000*: hours for so many pictures on the two cores.", "",
             "| scene | way | pictures a frame | worker, ms a frame | beside it, ms | ms a picture | times as fast | 25,000 |",
             "|---|---|---:|---:|---:|---:|---:|---:|"]
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as folder:
        for options.config in configs:
            rounds = [[measure(options, settings, folder) for _, settings in WAYS] for _ in range(options.rounds)]
            print(rounds, file=sys.stderr, flush=True)
            for way, (name, _) in enumerate(WAYS):
                own = [each[way] for each in rounds]
                worker, beside, pictures = (statistics.median(one[i] for one in own) for i in range(3))
                factor = statistics.median(each[0][0] / each[0][2] / (each[way][0] / each[way][2]) for each in rounds)
                hours = worker / pictures * 25_000 / 2 / 3600
                lines.append(f"| `{options.config.name}` | {name} | {pictures:.1f} | {1e3 * worker:.0f} | {1e3 * beside:.0f} | "
                             f"**{1e3 * worker / pictures:.1f}** | {factor:.1f} | {hours:.2f} h |")
    text = "\n".join(lines) + "\n"
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
