"""A bare loop over frames inside Blender, for tests/bench/overhead.py to compare `seedframe submit` with.

    blender --background --factory-startup -noaudio --threads T --python bare_loop.py -- JOB.json

JOB.json: {"scripts": "…/blender_scripts", "frames": [[frame.json, passes.exr], …], "meshes": {sha256: path}}.
Builds scenes and renders with the workers' own code: what differs is all that `submit` does around it.
Prints one line, `bare-loop {"begin": …, "end": …, "cpu_s": …}`: seconds on the clock of time.monotonic(), and CPU
seconds of all threads between them.
"""

import json
import pathlib
import sys
import time

sys.dont_write_bytecode = True
job = json.loads(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).read_text(encoding="utf-8"))
sys.path.insert(0, job["scripts"])

from passes import PassRenderer  # noqa: E402
from scene_builder import SceneBuilder  # noqa: E402

builder = SceneBuilder()
renderer = PassRenderer(builder.scene)
begin, cpu_begin = time.monotonic(), time.process_time()
for spec_path, output in job["frames"]:
    spec = json.loads(pathlib.Path(spec_path).read_text(encoding="utf-8"))
    builder.build(spec, job["meshes"], {})
    renderer.render(spec["render"], output, "bare loop")
times = {"begin": begin, "end": time.monotonic(), "cpu_s": time.process_time() - cpu_begin}
print("bare-loop " + json.dumps(times), flush=True)
