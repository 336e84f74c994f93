#!/usr/bin/python3
"""Does a worker's memory grow? Resident size after 50 and after 1,000 frames.

Each frame is 128 x 128 at 1 sample with 12 instances and 10 materials, all of other values than in the
frame before. Prints one JSON object; exits with 1 if the later size is above 1.2 times the earlier.

    tests/bench/worker_memory.py [--frames 1000] [--blender blender] [--report FILE]
"""

import argparse
import hashlib
import json
import math
import os
import pathlib
import random
import socket
import struct
import subprocess
import sys
import tempfile
import time

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "blender_scripts"
EARLY_FRAME = 50
LIMIT = 1.2


class Worker:
    """A Blender worker, driven by hand."""

    def __init__(self, blender, log, threads=1):
        ours, theirs = socket.socketpair()
        fd = str(theirs.fileno())
        self.process = subprocess.Popen(
            [blender, "--background", "--factory-startup", "--disable-autoexec", "-noaudio", "--threads",
             str(threads), "--python-exit-code", "3", "--python", str(SCRIPTS / "render_worker.py"), "--",
             "--read-fd", fd, "--write-fd", fd,
             "--cpus", ",".join(str(cpu) for cpu in sorted(os.sched_getaffinity(0)))],
            env={**os.environ, "PATH": "/usr/bin:/bin"},  # as the scheduler does
            pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        theirs.close()
        self._socket = ours
        self._reader = ours.makefile("rb")
        self.ready = self._answer()

    def render(self, spec, output, meshes, textures=None, frame=0):
        request = {"type": "render", "frame": frame, "attempt": 1, "spec": spec, "output": str(output),
                   "meshes": meshes, "textures": textures or {}}
        self._socket.sendall(json.dumps(request).encode() + b"\n")
        return self._answer()

    def resident_mb(self):
        pages = int(pathlib.Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def close(self):
        self._reader.close()
        self._socket.close()
        return self.process.wait(timeout=30)

    def _answer(self):
        line = self._reader.readline()
        if not line:
            sys.exit("the worker died; see its log")
        return json.loads(line)


def sphere_buffer(rings, slots=1, smooth_angle=0.5):
    """A UV sphere of radius 0.1 m as a mesh buffer."""
    segments = 2 * rings
    positions = [(0.1 * math.sin(math.pi * i / rings) * math.cos(math.pi * j / rings),
                  0.1 * math.sin(math.pi * i / rings) * math.sin(math.pi * j / rings),
                  0.1 * math.cos(math.pi * i / rings))
                 for i in range(rings + 1) for j in range(segments)]
    triangles, uvs = [], []
    for i in range(rings):
        for j in range(segments):
            a, b = i * segments + j, i * segments + (j + 1) % segments
            c, d = a + segments, b + segments
            corner_uv = {a: (j, rings - i), b: (j + 1, rings - i), c: (j, rings - i - 1),
                         d: (j + 1, rings - i - 1)}
            for triangle in ((a, c, d), (a, d, b)):
                if len({positions[corner] for corner in triangle}) == 3:
                    triangles.append(triangle)
                    uvs += [(u / segments, v / rings) for u, v in map(corner_uv.get, triangle)]
    pack = struct.pack
    return b"".join([
        b"SFMESH01", pack("<IIIf", len(positions), len(triangles), slots, smooth_angle),
        *(pack("<3f", *p) for p in positions), *(pack("<3I", *t) for t in triangles),
        *(pack("<2f", *uv) for uv in uvs),
        *(pack("<I", i % slots) for i in range(len(triangles)))])


def write_mesh(folder, data):
    name = hashlib.sha256(data).hexdigest()
    path = pathlib.Path(folder) / f"{name}.mesh"
    path.write_bytes(data)
    return name, str(path)


def random_spec(draw, mesh_names, size=128, samples=1, instances=12, materials=10):
    """A frame spec with every value drawn from `draw`, a random.Random."""
    def placed(x, y, z, scale=1.0):
        a = draw.uniform(0, 2 * math.pi)
        c, s = scale * math.cos(a), scale * math.sin(a)
        return [c, 0, s, x, 0, scale, 0, y, -s, 0, c, z, 0, 0, 0, 1]

    def color():
        return [draw.random() for _ in range(3)]

    return {
        "version": 1,
        "render": {"width": size, "height": size, "samples": samples, "seed": draw.getrandbits(31),
                   "max_bounces": 4, "filter_width_px": 1.5, "clamp_indirect": 0, "depth": True,
                   "normal": False},
        "camera": {"focal_px": size * 1.2, "clip_start_m": 0.01, "clip_end_m": 100},
        "world": {"color": color(), "strength": draw.uniform(0.2, 1)},
        "materials": [{"base_color": color(), "metallic": draw.random(), "roughness": draw.random(),
                       "specular": draw.random(), "transmission": draw.choice([0, draw.random()]),
                       "ior": draw.uniform(1.2, 1.6), "clearcoat": draw.random(), "texture_repeat": 1,
                       "textures": {}} for _ in range(materials)],
        "instances": [{"name": f"thing/{i}", "id": i + 1, "category": 1, "mesh": draw.choice(mesh_names),
                       "materials": [draw.randrange(materials)],
                       "camera_from_object": placed(draw.uniform(-.4, .4), draw.uniform(-.4, .4),
                                                    draw.uniform(-1.5, -.8), draw.uniform(.5, 1.5))}
                      for i in range(instances)],
        "lights": [{"kind": "point", "camera_from_light": placed(draw.uniform(-1, 1), 1, 0),
                    "color": color(), "power": 30, "radius_m": 0.05},
                   {"kind": "area", "camera_from_light": placed(0, draw.uniform(0, 1), 1),
                    "color": color(), "power": 20, "width_m": 0.5, "height_m": 0.3}],
        "image": {"display": "sRGB", "view": "Filmic", "look": "None", "exposure_stops": 0, "gamma": 1},
    }


def report(blender, sizes, growth):
    lines = [
        "# Memory of a worker", "",
        "Made by `scripts/bench.sh`; `tests/bench/worker_memory.py` says how. Every frame (128 × 128, 1 sample) has",
        f"other objects, meshes out of 20, materials and lights than the one before. Blender {blender}, one thread.",
        "", "| after frame | resident, MB |", "|---:|---:|",
        *(f"| {frame} | {size} |" for frame, size in sorted(sizes.items())), "",
        f"**{growth:.3f} ×** from frame {EARLY_FRAME} to frame {max(sizes)}; target ≤ {LIMIT}: "
        f"{'met' if growth <= LIMIT else 'missed'}.", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=1000)
    parser.add_argument("--blender", default="/usr/bin/blender")
    parser.add_argument("--report", type=pathlib.Path, help="write a table there")
    options = parser.parse_args()
    draw = random.Random(1)
    sizes, builds, renders = {}, [], []
    with tempfile.TemporaryDirectory() as folder, open(f"{folder}/log", "wb") as log:
        meshes = dict(write_mesh(folder, sphere_buffer(rings)) for rings in range(8, 28))
        worker = Worker(options.blender, log)
        begin = time.perf_counter()
        for frame in range(1, options.frames + 1):
            spec = random_spec(draw, sorted(meshes), instances=draw.randint(6, 18))
            answer = worker.render(spec, f"{folder}/passes.exr", meshes, frame=frame)
            if answer["type"] != "done":
                sys.exit(f"frame {frame}: {answer}")
            builds.append(answer["build_s"])
            renders.append(answer["render_s"])
            if frame in (EARLY_FRAME, options.frames) or frame % 250 == 0:
                sizes[frame] = round(worker.resident_mb(), 1)
        elapsed = time.perf_counter() - begin
        worker.close()
    growth = sizes[options.frames] / sizes[EARLY_FRAME]
    print(json.dumps({
        "resident_mb_after_frame": sizes, "growth": round(growth, 3),
        "median_build_ms": round(1000 * sorted(builds)[len(builds) // 2], 2),
        "median_render_ms": round(1000 * sorted(renders)[len(renders) // 2], 2),
        "frames_per_second": round(options.frames / elapsed, 1)}, indent=2))
    if options.report:
        options.report.write_text(report(worker.ready["blender"], sizes, growth), encoding="utf-8")
    return growth > LIMIT


if __name__ == "__main__":
    sys.exit(main())
