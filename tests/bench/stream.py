#!/usr/bin/python3
"""What a frame on demand costs: `seedframe stream` for each fidelity, beside a campaign of one frame for each request.

    tests/bench/stream.py [--report FILE.md] [--config FILE] [--images 50] [--blender B]

The scene of the third paper's target (configs/tyol_single_8_target.yaml) at 128 × 128, values drawn by the config. One request after the
other (latency), and as many at once as workers (throughput).
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build/release/seedframe"
SIZE = ["--set", "render.width=128", "--set", "render.height=128", "--set", "render.samples=1"]
GOALS = {"labels": 60, "preview": 125, "render": 1000}  # ms an image: the third paper's Unity for the first two


class Stream:
    def __init__(self, config, blender, *more):
        self.process = subprocess.Popen([PROGRAM, "stream", config, *SIZE, "--blender", blender, "--workers", "2", *more],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.hear()

    def hear(self):
        while True:
            line = json.loads(self.process.stdout.readline())
            if "alive" not in line:
                return line

    def ask(self, **request):
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()

    def close(self):
        self.process.stdin.close()
        if self.process.wait() != 0:
            sys.exit("the stream ended with an error")


def checked(answer):
    if "error" in answer:
        sys.exit(answer["error"]["message"])
    return answer


def measure(config, blender, fidelity, images):
    stream = Stream(config, blender)
    want = ["labels"] if fidelity == "labels" else ["labels", "image"]
    for i in range(4):  # workers start, assets are decoded
        stream.ask(id=f"warm {i}", fidelity=fidelity, scene=i, want=want)
    for _ in range(4):
        stream.ask(release=checked(stream.hear())["id"])
    latencies, beside = [], []
    for i in range(images):
        begin = time.perf_counter()
        stream.ask(id=i, fidelity=fidelity, scene=i, want=want)
        answer = checked(stream.hear())
        took = time.perf_counter() - begin
        latencies.append(took)
        beside.append(took - answer["seconds"]["made"])
        stream.ask(release=i)
    begin = time.perf_counter()
    for i in range(images):
        stream.ask(id=i, fidelity=fidelity, scene=i, want=want)
    for _ in range(images):
        stream.ask(release=checked(stream.hear())["id"])
    throughput = (time.perf_counter() - begin) / images
    stream.close()
    return {"latency_ms": 1e3 * statistics.median(latencies), "beside_ms": 1e3 * statistics.median(beside),
            "at_once_ms": 1e3 * throughput}


def anew(config, blender, images):
    """A campaign of one frame for each."""
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for i in range(images):
            subprocess.run([PROGRAM, "submit", config, *SIZE, "--frames", "1", "--quiet", "--blender", blender, "-o", f"{folder}/{i}",
                            "--set", f"seed={i}"], check=True, capture_output=True,
                           env={**os.environ, "SEEDFRAME_CACHE": "off"})
    return 1e3 * (time.perf_counter() - begin) / images


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--config", default=str(HOME / "configs/tyol_single_8_target.yaml"))
    parser.add_argument("--images", type=int, default=50)
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--report", type=pathlib.Path)
    options = parser.parse_args()
    rows = []
    for fidelity, goal in GOALS.items():
        figures = measure(options.config, options.blender, fidelity, options.images)
        verdict = "met" if figures["at_once_ms"] <= goal else "missed"
        rows.append(f"| `{fidelity}` | {figures['latency_ms']:.1f} | {figures['beside_ms']:.2f} | {figures['at_once_ms']:.1f} | "
                    f"{goal} | {verdict} |")
        print(rows[-1], flush=True)
        last = figures
    scratch = anew(options.config, options.blender, max(3, options.images // 10))
    text = f"""# Frames on demand

Made by `scripts/bench.sh stream` (`tests/bench/stream.py`): {options.images} images of 128 × 128 of `{pathlib.Path(options.config).name}`, {os.cpu_count()} cores,
two workers, Blender `{options.blender}`. *One by one*: from the request to the answer, the median. *Beside*: of that, what is not the frame's own making
(the lines' way, waiting), the median; goal 2 ms. *At once*: per image, with all requests sent ahead.

| fidelity | one by one, ms | beside, ms | at once, ms | goal, ms | |
|---|---:|---:|---:|---:|---|
""" + "\n".join(rows) + f"""

A campaign of one frame for each request, which starts Blender and builds the scene anew: {scratch:,.0f} ms an image,
{scratch / last['at_once_ms']:.1f} times as much as `render` by a stream.
"""
    if options.report:
        options.report.write_text(text)
    else:
        print(text)


main()
