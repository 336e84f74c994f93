"""The frames of a campaign as a user of BlenderProc 2.8 renders and labels them, for throughput.py.

    venv/blenderproc/bin/python blenderproc_loop.py JOB.json

JOB.json: {"scripts": "…/blender_scripts", "frames": [frame.json, …], "meshes": {sha256: path}, "threads": T, "output":
folder}. As bare_loop.py it takes the reading of a mesh buffer into Blender from the workers' code, and nothing else.
Objects, materials and the light are made once; what a frame changes is set before its call of render(), as BlenderProc's
page on key frames says of what has none, such as materials.

Prints one line, `blenderproc-loop {"begin": …, "end": …}`: seconds on the clock of time.monotonic(), from before
the first frame is set up until the COCO annotations of all are written.
"""

import collections
import importlib
import json
import os
import pathlib
import sys
import sysconfig
import tempfile
import time

import bpy
from mathutils import Matrix

# This release starts a Blender that it has downloaded, installs packages into it, and gives its interface to scripts in
# there only. Here Blender is a module and the packages are there: it is told that it is inside, and to install nothing.
os.environ["OUTSIDE_OF_THE_INTERNAL_BLENDER_PYTHON_ENVIRONMENT_BUT_IN_RUN_SCRIPT"] = "1"
import blenderproc as bproc  # noqa: E402
from blenderproc.python.utility.SetupUtility import SetupUtility  # noqa: E402

SetupUtility.setup = lambda *_: None
os.environ["INSIDE_OF_THE_INTERNAL_BLENDER_PYTHON_ENVIRONMENT"] = "1"
sys.path.append(sysconfig.get_path("purelib"))  # it takes its folder out of the path, and with it all else in there
bproc = importlib.reload(bproc)
from blenderproc.python.utility.Initializer import _Initializer  # noqa: E402

_INPUTS = {"metallic": "Metallic", "roughness": "Roughness", "specular": "Specular IOR Level",
           "transmission": "Transmission Weight", "ior": "IOR", "clearcoat": "Coat Weight"}


class Scene:
    """What is made once, and one frame after the other set in it."""

    def __init__(self, specs, load_mesh):
        # bproc.init(), but for the language of the windows, of which the module has one only.
        bproc.clean_up(clean_up_camera=True)
        bpy.context.scene.render.engine = "CYCLES"
        bproc.renderer.set_render_devices()
        _Initializer.set_default_parameters()
        self._objects = collections.defaultdict(list)  # by mesh; the ground is one
        self._slots = {}
        most = collections.Counter()
        categories = {}
        for spec in specs:
            for mesh, count in collections.Counter(each["mesh"] for each in spec["instances"]).items():
                most[mesh] = max(most[mesh], count)
            categories.update((each["mesh"], each["category"]) for each in spec["instances"])
        for mesh, count in most.items():
            for _ in range(count):
                self._objects[mesh].append(self._new_object(load_mesh(mesh), categories[mesh]))
        self._light = bproc.types.Light("AREA")
        self._light.blender_obj.data.shape = "RECTANGLE"

    def _new_object(self, mesh, category):
        item = bpy.data.objects.new(mesh.name, mesh)
        bpy.context.scene.collection.objects.link(item)
        entity = bproc.types.MeshObject(item)
        entity.set_cp("category_id", category)
        self._slots[entity] = []
        for slot in item.material_slots:
            material = bproc.material.create("material")
            slot.link = "OBJECT"  # objects share their mesh and not their colours
            slot.material = material.blender_obj
            self._slots[entity].append(material)
        return entity

    def place(self, spec):
        render, camera, light = spec["render"], spec["camera"], spec["lights"][0]
        (fx, fy), (cx, cy) = camera["focal_px"], camera["center_px"]
        bproc.camera.set_intrinsics_from_K_matrix([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], render["width"],
                                                  render["height"], camera["clip_start_m"], camera["clip_end_m"])
        bproc.renderer.set_world_background(spec["world"]["color"], spec["world"]["strength"])
        self._light.set_local2world_mat(_matrix(light["camera_from_light"]))
        self._light.set_color(light["color"])
        self._light.set_energy(light["power"])
        self._light.blender_obj.data.size, self._light.blender_obj.data.size_y = light["width_m"], light["height_m"]
        used = collections.Counter()
        for instance in spec["instances"]:
            entity = self._objects[instance["mesh"]][used[instance["mesh"]]]
            used[instance["mesh"]] += 1
            entity.hide(False)
            entity.set_local2world_mat(_matrix(instance["camera_from_object"]))
            for material, number in zip(self._slots[entity], instance["materials"]):
                _set_material(material, spec["materials"][number])
        for mesh, entities in self._objects.items():
            for entity in entities[used[mesh]:]:
                entity.hide()


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    sys.dont_write_bytecode = True
    sys.path.insert(0, job["scripts"])
    from mesh_cache import MeshCache

    specs = [json.loads(pathlib.Path(path).read_text(encoding="utf-8")) for path in job["frames"]]
    for spec in specs:
        if any(each["textures"] for each in spec["materials"]) or [each["kind"] for each in spec["lights"]] != ["area"]:
            sys.exit("blenderproc_loop.py knows scenes without textures, under one area light")
    meshes = MeshCache(max_triangles=10**9)
    with tempfile.TemporaryDirectory(dir="/dev/shm") as shared_memory:  # where it puts its images by itself, too
        SetupUtility.setup_utility_paths(shared_memory)
        scene = Scene(specs, lambda sha256: meshes.get(sha256, job["meshes"]))
        _set_up_renderer(specs[0]["render"], job["threads"])
        begin = time.monotonic()
        frames = _render(scene, specs)
        # All at once: each call would read and write the whole file again.
        bproc.utility.set_keyframe_render_interval(frame_start=0, frame_end=len(specs))
        bproc.writer.write_coco_annotations(job["output"], instance_segmaps=frames["instance_segmaps"],
                                            instance_attribute_maps=frames["instance_attribute_maps"],
                                            colors=frames["colors"], append_to_existing_output=False)
        print("blenderproc-loop " + json.dumps({"begin": begin, "end": time.monotonic()}), flush=True)


def _set_up_renderer(render, threads):
    bproc.renderer.set_cpu_threads(threads)
    bproc.renderer.set_max_amount_of_samples(render["samples"])
    bproc.renderer.set_noise_threshold(0)
    bproc.renderer.set_denoiser(None)
    bounces = render["max_bounces"]
    bproc.renderer.set_light_bounces(diffuse_bounces=bounces, glossy_bounces=bounces, max_bounces=bounces,
                                     transmission_bounces=bounces)
    bproc.renderer.enable_segmentation_output(map_by=["category_id", "instance", "name"])


def _render(scene, specs):
    """What render() returns, of all frames."""
    frames = collections.defaultdict(list)
    for spec in specs:
        bproc.utility.reset_keyframes()
        bproc.camera.add_camera_pose(Matrix())  # frame specs are relative to the camera
        scene.place(spec)
        for name, of_frame in bproc.renderer.render(verbose=True).items():  # a progress bar would take time
            frames[name] += of_frame
    return frames


def _set_material(material, spec):
    material.set_principled_shader_value("Base Color", (*spec["base_color"], 1.0))
    for name, socket in _INPUTS.items():
        material.set_principled_shader_value(socket, spec[name])


def _matrix(numbers):
    return Matrix((numbers[0:4], numbers[4:8], numbers[8:12], numbers[12:16]))


main()
sys.stderr.flush()
os._exit(0)  # the module's own way out crashes
