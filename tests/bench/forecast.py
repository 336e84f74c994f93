#!/usr/bin/python3
"""Does `submit --dry-run --pilot` tell how long a campaign takes, and how much room?

Each campaign is forecast and then submitted, a few times over; the forecast is compared with the time from the command
to its end, and with the size of its folder. Goal: within 20 %.

    tests/bench/forecast.py [--rounds 2] [--pilots 8] [--blender BLENDER] [--report FILE]

Exits with 1 if the median of any campaign is further off.
"""

import argparse
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from overhead import OtherLoad, version_of

HOME = pathlib.Path(__file__).resolve().parents[2]
MOST_OFF = 0.20
CASES = (("the demo as shipped", "parts.yaml", ()),
         ("128 × 128, 1 sample", "bench_small.yaml", ("scenes=600",)),
         ("the RoboCup scene, 213 × 160, 4 samples", "robocup_spl.yaml",
          ("render.width=213", "render.height=160", "render.samples=4", "scenes=8")),
         ("labels alone, 320 × 240", "parts.yaml", ("labels=geometry", "frames_per_scene=100")))
UNITS = {"s": 1, "min": 60, "h": 3600, "kB": 1e3, "MB": 1e6, "GB": 1e9}


def told(output):
    """Seconds and bytes of the line "about 3 min 20 s and 66.7 MB, by …"."""
    line = re.search(r"^about (.*) and ([\d.]+) (kB|MB|GB), by", output, re.MULTILINE)
    seconds = sum(int(number) * UNITS[unit] for number, unit in re.findall(r"(\d+) (s|min|h)", line[1]))
    return seconds, float(line[2]) * UNITS[line[3]]


def size_of(folder):
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def measure(options, config, settings, folder):
    watch = OtherLoad()
    command = [options.program, "submit", HOME / "configs" / config, "-o", folder, "--quiet", "--blender", options.blender]
    for setting in settings:
        command += ["--set", setting]
    environment = {**os.environ, "SEEDFRAME_CACHE": "off"}
    forecast = subprocess.run([*command, "--dry-run", "--pilot", str(options.pilots)], check=True, env=environment,
                              capture_output=True, text=True).stdout
    begin = time.monotonic()
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begin
    size = size_of(folder)
    shutil.rmtree(folder)
    result = (*told(forecast), seconds, size, watch.cores())
    print(config, result, file=sys.stderr, flush=True)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--pilots", type=int, default=8)
    parser.add_argument("--blender", default=f"python:{HOME}/venv/blender-4.5")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    lines = ["# What a campaign will take, forecast", "",
             "Made by `scripts/bench.sh forecast`; `tests/bench/forecast.py` says how. "
             f"`submit --dry-run --pilot {options.pilots}`, then `submit`, {options.rounds} times; {version_of(options.blender)}, "
             f"{os.cpu_count()} cores. Goal: within {100 * MOST_OFF:.0f} %.", "",
             "| campaign | forecast | taken | off by | size forecast | size | off by | goal |", "|---|---|---|---|---|---|---|---|"]
    good, busiest = True, 0.0
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        for what, config, settings in CASES:
            rounds = [measure(options, config, settings, pathlib.Path(name) / "campaign") for _ in range(options.rounds)]
            off_time = statistics.median(each[0] / each[2] - 1 for each in rounds)
            off_size = statistics.median(each[1] / each[3] - 1 for each in rounds)
            met = max(abs(off_time), abs(off_size)) <= MOST_OFF
            good, busiest = good and met, max(busiest, *(each[4] for each in rounds))
            lines.append(f"| {what} | {', '.join(f'{each[0]:.0f}' for each in rounds)} s | "
                         f"{', '.join(f'{each[2]:.1f}' for each in rounds)} s | **{100 * off_time:+.0f} %** | "
                         f"{rounds[0][1] / 1e6:.1f} MB | {rounds[0][3] / 1e6:.1f} MB | {100 * off_size:+.0f} % | "
                         f"{'met' if met else 'missed'} |")
    if busiest > 0.2:
        lines += ["", f"The machine was not idle: other programs kept up to {busiest:.1f} of its cores busy meanwhile."]
    text = "\n".join(lines) + "\n"
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
