"""The program of a worker: renders the frames that the scheduler sends until it closes the channel.

A pure function from frame spec to passes: nothing here is random and nothing is decided here.
Started by Blender as docs/formats/worker-protocol.md says.
"""

import argparse
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder may belong to somebody else

import bpy  # noqa: E402

import cpu_kernel  # noqa: E402
import render_devices  # noqa: E402
from passes import PassRenderer, sharp_output  # noqa: E402
from protocol import SPEC_VERSIONS, Channel, Done, Failed, Ready  # noqa: E402
from saved_scene import save_scene  # noqa: E402
from scene_builder import SceneBuilder  # noqa: E402

_LONGEST_ERROR = 2000
_SIGN_OF_LIFE_S = 2.0


def main():
    options = _parse_options()
    # Blender was started on one CPU, so that it computes normals in one order (docs/determinism.md).
    os.sched_setaffinity(0, options.cpus)
    channel = Channel(options.read_fd, options.write_fd)
    builder = SceneBuilder()
    renderer = PassRenderer(builder.scene, options.persistent_data, options.device)
    channel.send(_ready(render_devices.use(options.device)))
    _silence_stdout()
    channel.send_signs_of_life(_SIGN_OF_LIFE_S)
    for request in channel.requests():
        channel.send(_answer(request, builder, renderer))
    _leave()


def _answer(request, builder, renderer):
    begin, cpu_begin = time.perf_counter(), time.process_time()
    try:
        if request.spec.get("version") not in SPEC_VERSIONS:
            raise ValueError(f"frame spec of version {request.spec.get('version')}; this worker reads "
                             f"{SPEC_VERSIONS}")
        builder.build(request.spec, request.meshes, request.textures)
        built = time.perf_counter()
        renderer.render(request.spec["render"], request.output, request.frame_id, request.sample_counts)
        if request.save_scene:
            save_scene(request.output)
        if builder.make_sharp():  # the lens disturbs all passes: labels come from a pinhole
            once = {**request.spec["render"], "samples": 1, "adaptive": None, "denoise": "off"}
            renderer.render(once, sharp_output(request.output), request.frame_id)
    except MemoryError:
        raise  # a fresh worker may have enough
    except Exception as error:  # one bad frame must not cost the worker
        text = f"{type(error).__name__}: {error}".strip()
        return Failed(request.frame, request.attempt, text[-_LONGEST_ERROR:])
    return Done(request.frame, request.attempt, built - begin, time.perf_counter() - built,
                time.process_time() - cpu_begin)


def _ready(device):
    build = bpy.app.build_hash
    return Ready(
        blender=".".join(str(number) for number in bpy.app.version),
        build=build.decode("ascii", "replace") if isinstance(build, bytes) else str(build),
        ocio_config=_ocio_config(),
        kernel=cpu_kernel.current(bpy.app.version),
        embree=cpu_kernel.embree(),
        reciprocals=cpu_kernel.reciprocals(),
        libc=cpu_kernel.libc(),
        device=device,
        devices=render_devices.text_of(render_devices.present()),
        denoisers=", ".join(render_devices.denoisers()),
    )


def _ocio_config():
    if os.environ.get("OCIO"):  # Blender prefers it too
        return os.environ["OCIO"]
    folder = bpy.utils.system_resource("DATAFILES", path="colormanagement")
    return os.path.join(folder, "config.ocio") if folder else ""


def _silence_stdout():
    """Blender prints some lines for each frame; errors come by exceptions or stderr."""
    sys.stdout.flush()
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def _leave():
    """Blender's own way out frees every datablock first, which nobody needs."""
    try:
        for entry in os.scandir(bpy.app.tempdir):
            os.remove(entry)
        os.rmdir(bpy.app.tempdir)
    except OSError:
        pass
    sys.stderr.flush()
    os._exit(0)


def _parse_options():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="render_worker.py")
    parser.add_argument("--read-fd", type=int, required=True)
    parser.add_argument("--write-fd", type=int, required=True)
    parser.add_argument("--cpus", type=lambda text: [int(cpu) for cpu in text.split(",")], required=True)
    parser.add_argument("--persistent-data", action="store_true")
    parser.add_argument("--device", default="cpu")
    return parser.parse_args(arguments)


main()
