"""A bare loop over frames inside Blender, for tests/bench/overhead.py to compare `seedframe submit` with.

    blender --background --factory-startup -noaudio --threads T --python bare_loop.py -- JOB.json

JOB.json: {"scripts": "…/blender_scripts", "frames": [[frame.json, passes.exr], …], "meshes": {sha256: path},
"textures": {sha256: path}}. Of the workers' code it uses what reads a mesh buffer into Blender, once for each mesh.
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

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from bare_scene import BareScene  # noqa: E402
from mesh_cache import MeshCache  # noqa: E402

meshes = MeshCache(max_triangles=10**9)
scene = BareScene(lambda sha256: meshes.get(sha256, job["meshes"]), job["textures"])
begin, cpu_begin = time.monotonic(), time.process_time()
for spec_path, output in job["frames"]:
    spec = json.loads(pathlib.Path(spec_path).read_text(encoding="utf-8"))
    scene.render(spec, output)
times = {"begin": begin, "end": time.monotonic(), "cpu_s": time.process_time() - cpu_begin}
print("bare-loop " + json.dumps(times), flush=True)
