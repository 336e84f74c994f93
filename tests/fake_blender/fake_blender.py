#!/usr/bin/python3
"""Stands in for Blender where faults are tested: speaks the worker protocol, and misbehaves on request.

A frame is a rectangle for each instance at its projected position, written as the multilayer EXR that
Blender would write. It is a pure function of the frame spec.

SEEDFRAME_FAKE in the environment is a JSON object; all keys are optional:

    "<fault>_frames": [3, 5] or "all"   which frames meet the fault (see FAULTS)
    "<fault>_attempts": 2               the fault stays away after so many attempts; 1 by default
    "die_before_ready": true            ends at once; a number: so do the first N starts (starts_log)
    "hang_before_ready": true
    "protocol": 2                       the version in "ready"
    "chatty_log_bytes": 1000            printed for each frame
    "delay_s": 0.1                      for each frame
    "frame_s": 0.017                    that a frame takes in all, if drawing it takes no longer
    "no_denoiser": true                 frames that are to be denoised fail
    "starts_log": "path"                gets one line, the process id, for each start
    "kernel": "avx"                     that it says it has, and "kernel_from": "path" the file that says it
    "depends_on": ["threads", "locale"] what a pixel of every frame depends on (see DEPENDENCIES)
"""

import json
import os
import pathlib
import signal
import struct
import sys
import threading
import time
import zlib

FAULTS = {
    "crash": "segmentation fault while rendering",
    "exit": "ends in good order, without an answer",
    "hang": "never answers, but gives signs of life",
    "ignore_term": "the same, and SIGTERM does nothing",
    "freeze": "stops (SIGSTOP)",
    "out_of_memory": "is killed as the kernel does when memory runs out",
    "garbage": "answers with something else than a message",
    "wrong_frame": "answers about another frame",
    "wrong_attempt": "answers about another attempt",
    "fail": "answers 'failed'",
    "no_file": "says 'done' and writes nothing",
    "other_frame": "says 'done' after writing the picture of another frame",
    "half_exr": "says 'done' after half a file",
    "nan": "a NaN in the combined pass",
    "wrong_size": "an image one pixel too wide",
    "wrong_id": "an index that no instance has",
    "fractional_id": "an index between two instances",
    # Frames that nothing is wrong with, but which are not the same again:
    "last_bit": "one value of the combined pass is the next half float",
    "brighter": "the combined pass is brighter by 0.02",
    "other_label": "the first pixel of the first instance has no index",
}
DEPENDENCIES = {
    "threads": lambda rendered: sys.argv[sys.argv.index("--threads") + 1],
    "history": lambda rendered: rendered > 0,
    "persistent data": lambda rendered: rendered > 0 and "--persistent-data" in sys.argv,
    "tmpdir": lambda rendered: " " in os.environ.get("TMPDIR", ""),
    "locale": lambda rendered: os.environ.get("LC_ALL", "").startswith("de"),
    "timezone": lambda rendered: os.environ.get("TZ", ""),
    "locale and timezone": lambda rendered: os.environ.get("LC_ALL", "").startswith("de") and "TZ" in os.environ,
    "kernel": lambda rendered: kernel(),
    "nothing": lambda rendered: time.time_ns(),
}
BACKGROUND_DEPTH = 1e10


def main():
    if "--version" in sys.argv:
        print("Blender 3.4.1")
        return 0
    wishes = json.loads(os.environ.get("SEEDFRAME_FAKE", "{}"))
    start = note_start(wishes)
    if is_wished(wishes.get("die_before_ready", False), start):
        print("fake: cannot open the display of the fake", file=sys.stderr)
        return 1
    if wishes.get("hang_before_ready"):
        hang()
    if "frame_s" in wishes:
        import numpy  # noqa: F401 - so that the first frame is as fast as the others
    reader = os.fdopen(option("--read-fd"), "rb", closefd=False)
    send({"type": "ready", "protocol": wishes.get("protocol", 5), "blender": "3.4.1", "build": "fake",
          "ocio_config": "", "kernel": wished_kernel(wishes), "embree": os.environ.get("SEEDFRAME_EMBREE_ISA", "avx2"), "reciprocals": "fake", "libc": "",
          "device": wished_device(wishes), "devices": ", ".join(["CPU (fake)", *wishes.get("devices", [])]),
          "denoisers": wishes.get("denoisers", "")})
    threading.Thread(target=give_signs_of_life, daemon=True).start()
    for rendered, line in enumerate(reader):
        send(answer(json.loads(line), wishes, rendered))
    return 0


def wished_device(wishes):
    """What of its devices, such as "CUDA (fake)", is of the kind that the scheduler asks for."""
    if "--device" not in sys.argv:
        return "cpu"
    kind = sys.argv[sys.argv.index("--device") + 1].upper()
    return ", ".join(device for device in wishes.get("devices", []) if device.startswith(kind + " "))


def wished_kernel(wishes):
    if "kernel_from" in wishes:
        return pathlib.Path(wishes["kernel_from"]).read_text(encoding="ascii").strip()
    return wishes.get("kernel", kernel())


def kernel():
    return "avx" if "CYCLES_CPU_NO_AVX2" in os.environ else "avx2"


def answer(request, wishes, rendered):
    """The `rendered` frames before are of no account, unless it is wished for."""
    begin = time.monotonic()
    frame, attempt = request["frame"], request["attempt"]
    fault = next((f for f in FAULTS if meets(wishes, f, frame, attempt)), None)
    print("." * wishes.get("chatty_log_bytes", 0), flush=True)
    time.sleep(wishes.get("delay_s", 0))
    if wishes.get("no_denoiser") and request["spec"]["render"].get("denoise", "off") != "off":
        return {"type": "failed", "frame": frame, "attempt": attempt, "error": "this Blender has no Open Image Denoise"}
    if fault == "crash":
        print(f"fake: frame {frame} is too much", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)
    if fault == "exit":
        os._exit(0)
    if fault == "out_of_memory":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "ignore_term":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    if fault == "freeze":
        os.kill(os.getpid(), signal.SIGSTOP)
    if fault in ("hang", "ignore_term"):
        hang()
    if fault == "garbage":
        os.write(option("--write-fd"), b"Fra:1 Mem:22.00M | Scene, ViewLayer\n")
        hang()
    if fault == "fail":
        return {"type": "failed", "frame": frame, "attempt": attempt, "error": "fake: will not render"}
    if fault != "no_file":
        frame_id = "0" * 64 if fault == "other_frame" else request["frame_id"]
        dependencies = [str(DEPENDENCIES[name](rendered)) for name in wishes.get("depends_on", [])]
        data = exr_bytes(*draw(request["spec"], fault, dependencies, request.get("sample_counts")), frame_id)
        pathlib.Path(request["output"]).write_bytes(
            data[:len(data) // 2] if fault == "half_exr" else data)
    render_s = 0.002
    if "frame_s" in wishes:
        time.sleep(max(0.0, begin + wishes["frame_s"] - time.monotonic()))
        render_s = time.monotonic() - begin
    return {"type": "done", "frame": frame + (fault == "wrong_frame"),
            "attempt": attempt + (fault == "wrong_attempt"), "build_s": 0.001, "render_s": render_s, "cpu_s": 0.003}


def draw(spec, fault=None, dependencies=(), sample_counts=False):
    """(width, height, channels) of the frame; channels are (name, array) in the order of an EXR."""
    import numpy  # late: it takes longer to load than many tests take

    render = spec["render"]
    width, height = render["width"] + (fault == "wrong_size"), render["height"]
    combined = numpy.ones((height, width, 4))
    combined[..., :3] = [c * spec["world"]["strength"] for c in spec["world"]["color"]]
    index = numpy.zeros((height, width))
    depth = numpy.full((height, width), BACKGROUND_DEPTH)
    normal = numpy.zeros((height, width, 3))
    for instance in sorted(spec["instances"], key=lambda i: i["camera_from_object"][11]):
        rows, columns, z = rectangle(instance["camera_from_object"], spec["camera"]["focal_px"], width,
                                     height)
        material = spec["materials"][instance["materials"][0]] if instance["materials"] else {}
        combined[rows, columns, :3] = material.get("base_color", [1, 1, 1])
        index[rows, columns] = instance["id"]
        depth[rows, columns] = z
        normal[rows, columns] = (0, 0, 1)
    combined[0, 0, :3] = (render["seed"] % 1000) / 1000  # so that the seed shows
    for text in dependencies:
        combined[2, 2, 0] += zlib.crc32(text.encode()) % 100 / 10000
    if fault == "last_bit":
        combined[1, 1, 0] = numpy.nextafter(combined[1, 1, 0].astype("<f2"), numpy.float16(9))
    if fault == "brighter":
        combined[..., :3] += 0.02
    if fault == "other_label" and index.any():
        index[tuple(numpy.argwhere(index)[0])] = 0
    if fault == "nan":
        combined[height // 2, width // 2] = float("nan")
    if fault == "wrong_id":
        index[height // 2, width // 2] = 32767
    if fault == "fractional_id":
        index[height // 2, width // 2] = 0.5
    if "region" in render:
        x, y, width, height = render["region"]
        combined, index, depth, normal = (
            layer[y:y + height, x:x + width] for layer in (combined, index, depth, normal))
    layers = [(f"Combined.{c}", combined[..., i].astype("<f2")) for i, c in enumerate("RGBA")]
    layers.append(("IndexOB.X", index.astype("<f4")))
    if render["depth"]:
        layers.append(("Depth.Z", depth.astype("<f4")))
    if render["normal"]:
        layers += [(f"Normal.{c}", normal[..., i].astype("<f4")) for i, c in enumerate("XYZ")]
    if sample_counts:  # no pixel needs more than the others
        layers.append(("Debug Sample Count.X", numpy.ones(index.shape, "<f4")))
    return width, height, sorted((f"ViewLayer.{name}", pixels) for name, pixels in layers)


def rectangle(matrix, focal_px, width, height):
    """Rows, columns and depth of a square of 0.2 m at an instance's origin; empty behind the camera."""
    x, y, z = matrix[3], matrix[7], -matrix[11]
    if z <= 0:
        return slice(0, 0), slice(0, 0), 0.0
    focal_px = focal_px[0]
    column = (width - 1) / 2 + focal_px * x / z
    row = (height - 1) / 2 - focal_px * y / z
    half = 0.1 * focal_px / z

    def span(centre, limit):
        return slice(min(max(round(centre - half), 0), limit), min(max(round(centre + half), 0), limit))

    return span(row, height), span(column, width), z


def exr_bytes(width, height, channels, frame_id):
    """An uncompressed scan-line OpenEXR file (openexr.com, "OpenEXR File Layout")."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channel_list = b"".join(
        name.encode() + b"\0" + struct.pack("<iB3xii", 1 if pixels.dtype == "<f2" else 2, 0, 1, 1)
        for name, pixels in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"".join([
        struct.pack("<ii", 20000630, 2 | 0x400),  # magic; version 2 with names of up to 255 bytes
        attribute("Note", "string", frame_id.encode()), attribute("channels", "chlist", channel_list), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)), b"\0"])
    line_bytes = sum(pixels[0].nbytes for _, pixels in channels)
    first = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first + y * (8 + line_bytes) for y in range(height)))
    lines = b"".join(
        struct.pack("<ii", y, line_bytes) + b"".join(pixels[y].tobytes() for _, pixels in channels)
        for y in range(height))
    return header + offsets + lines


def meets(wishes, fault, frame, attempt):
    frames = wishes.get(fault + "_frames", [])
    return (frames == "all" or frame in frames) and attempt <= wishes.get(fault + "_attempts", 1)


def note_start(wishes):
    """Which start this is, from 1, as far as the log of starts knows."""
    if "starts_log" not in wishes:
        return 1
    with open(wishes["starts_log"], "a+", encoding="ascii") as log:
        log.write(f"{os.getpid()}\n")
        log.flush()
        log.seek(0)
        return len(log.readlines())


def is_wished(wish, start):
    return wish if isinstance(wish, bool) else start <= wish


def option(name):
    return int(sys.argv[sys.argv.index(name) + 1])


def send(message):
    os.write(option("--write-fd"), json.dumps(message).encode() + b"\n")


def give_signs_of_life():
    while True:
        send({"type": "alive", "memory_bytes": 50_000_000})
        time.sleep(0.5)


def hang():
    while True:
        time.sleep(3600)


if __name__ == "__main__":
    sys.exit(main())
