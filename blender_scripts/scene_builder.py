"""Puts a frame spec into Blender's scene.

Objects, lights and materials are kept and used again, because making them costs more than rendering a
small frame. Nothing of an earlier frame may show: every value is overwritten, the order of objects is
that of the spec, and what a frame does not use is out of the scene.
"""

import collections

import bpy
from mathutils import Matrix

import blender_versions
from image_cache import ImageCache
from kept_values import put
from material_pool import MaterialPool
from mesh_cache import MeshCache
from world_builder import WorldBuilder

_SENSOR_MM = 36.0
_LIGHT_TYPES = {"point": "POINT", "sun": "SUN", "spot": "SPOT", "area": "AREA"}


class SceneBuilder:
    def __init__(self):
        self.scene = bpy.context.scene
        _empty_the_file()
        self._camera = self._add_camera()
        self._images = ImageCache()
        self._world = WorldBuilder(self.scene, self._images)
        self._meshes = MeshCache()
        self._materials = MaterialPool(self._images)
        self._nothing = bpy.data.meshes.new("nothing")
        self._instances = _ObjectPool(self.scene, "instance", self._camera)
        self._lights = _ObjectPool(self.scene, "light", self._camera)
        self._light_data = {}  # (kind, index) -> light

    def build(self, spec, mesh_paths, texture_paths):
        for cache in (self._meshes, self._images, self._materials):
            cache.next_frame()
        self._set_camera(spec["camera"], spec["render"])
        self._world.set(spec["world"], texture_paths)
        self._instances.resize(len(spec["instances"]), self._nothing)
        for index, instance in enumerate(spec["instances"]):
            self._set_instance(index, instance, mesh_paths)
        self._set_materials(spec, mesh_paths, texture_paths)
        self._set_lights(spec["lights"])
        for cache in (self._meshes, self._images, self._materials):
            cache.trim()

    def _add_camera(self):
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        self.scene.collection.objects.link(camera)
        self.scene.camera = camera
        camera.data.sensor_fit = "HORIZONTAL"
        camera.data.sensor_width = _SENSOR_MM
        return camera

    def _set_camera(self, spec, render):
        focal_x, focal_y = spec["focal_px"]
        width, height = render["width"], render["height"]
        lens_mm = focal_x * _SENSOR_MM / width
        camera = self._camera.data
        center_x, center_y = spec["center_px"]
        put(camera, lens=lens_mm,
            shift_x=((width - 1) / 2 - center_x) / width,
            shift_y=(center_y - (height - 1) / 2) / width * focal_x / focal_y,
            clip_start=spec["clip_start_m"], clip_end=spec["clip_end_m"])
        # Pixels that are not square make the two focal lengths differ; neither aspect may be below 1.
        put(self.scene.render, pixel_aspect_x=max(1.0, focal_y / focal_x),
            pixel_aspect_y=max(1.0, focal_x / focal_y))
        camera.dof.use_dof = spec["aperture_radius_m"] > 0.0
        if camera.dof.use_dof:
            camera.dof.focus_object = None
            put(camera.dof, focus_distance=spec["focus_distance_m"],
                aperture_fstop=0.001 * lens_mm / (2.0 * spec["aperture_radius_m"]))
            camera.dof.aperture_blades = 0
            camera.dof.aperture_ratio = 1.0

    def make_sharp(self):
        """Turns depth of field off; False when there was none."""
        was_on = self._camera.data.dof.use_dof
        self._camera.data.dof.use_dof = False
        return was_on

    def _set_instance(self, index, spec, mesh_paths):
        mesh = self._meshes.get(spec["mesh"], mesh_paths)
        if len(spec["materials"]) != len(mesh.materials):
            raise ValueError(f"instance {spec['name']} brings {len(spec['materials'])} materials for "
                             f"the {len(mesh.materials)} slots of its mesh")
        item = self._instances[index]
        item.data = mesh
        item.pass_index = spec["id"]
        item.matrix_parent_inverse = _matrix(spec["camera_from_object"], self._meshes.origin(spec["mesh"]))
        hidden_from = spec["hidden_from"]
        for kind in ("camera", "diffuse", "glossy", "transmission", "shadow"):
            setattr(item, f"visible_{kind}", kind not in hidden_from)

    def _set_materials(self, spec, mesh_paths, texture_paths):
        """Slots belong to the meshes: one material for all that the instances of a mesh wear there."""
        worn = collections.defaultdict(set)  # (mesh, slot) -> indices of materials
        for instance in spec["instances"]:
            for slot, material in enumerate(instance["materials"]):
                worn[instance["mesh"], slot].add(material)
        wardrobes, shared = {}, {}  # meshes that wear the same share it
        for (mesh, slot), indices in worn.items():
            key = (slot, tuple(sorted(indices)))
            if key not in shared:
                materials = [spec["materials"][index] for index in key[1]]
                shared[key] = self._materials.get(slot, materials, texture_paths)
            wardrobes[mesh, slot] = shared[key]
            self._meshes.get(mesh, mesh_paths).materials[slot] = shared[key].material
        for index, instance in enumerate(spec["instances"]):
            for slot, material in enumerate(instance["materials"]):
                wardrobes[instance["mesh"], slot].dress(self._instances[index], spec["materials"][material])

    def _set_lights(self, specs):
        # Objects need some data when they are made, so the data comes first.
        lights = [self._light(index, spec) for index, spec in enumerate(specs)]
        self._lights.resize(len(lights), *lights[:1])
        for index, (light, spec) in enumerate(zip(lights, specs)):
            self._lights[index].data = light
            self._lights[index].matrix_parent_inverse = _matrix(spec["camera_from_light"])
            self._lights[index].visible_camera = False  # lights light, they are not things to see

    def _light(self, index, spec):
        kind = spec["kind"]
        light = self._light_data.get((kind, index))
        if light is None:
            light = bpy.data.lights.new(f"{kind}.{index:03}", _LIGHT_TYPES[kind])
            self._light_data[kind, index] = light
        light.color = spec["color"]
        light.energy = spec["power"]
        if kind == "area":
            light.energy *= blender_versions.area_light_factor(bpy.app.version)
        if kind in ("point", "spot"):
            light.shadow_soft_size = spec["radius_m"]
        if kind == "spot":
            put(light, spot_size=spec["angle_rad"], spot_blend=spec["blend"])
        if kind == "sun":
            put(light, angle=spec["angle_rad"])
        if kind == "area":
            light.shape = "RECTANGLE"
            light.size = spec["width_m"]
            light.size_y = spec["height_m"]
        return light


class _ObjectPool:
    """Objects of one sort, in the scene in the order of their index."""

    def __init__(self, scene, name, camera):
        self._name = name
        self._camera = camera
        self._collection = bpy.data.collections.new(name)
        scene.collection.children.link(self._collection)
        self._objects = []
        self._linked = 0

    def __getitem__(self, index):
        return self._objects[index]

    def resize(self, count, data=None):
        """Exactly `count` objects in the scene; new ones begin with `data`."""
        while len(self._objects) < count:
            item = bpy.data.objects.new(f"{self._name}.{len(self._objects):05}", data)
            # An object's own transform is kept as location, rotation and scale, and rounds; the
            # matrix between it and its parent is kept as it is.
            item.parent = self._camera
            self._objects.append(item)
        while self._linked < count:
            self._collection.objects.link(self._objects[self._linked])
            self._linked += 1
        while self._linked > count:
            self._linked -= 1
            self._collection.objects.unlink(self._objects[self._linked])
            if self._objects[self._linked].type == "MESH":
                # Removing a mesh from the cache would remove the objects that have it.
                self._objects[self._linked].data = data


def _matrix(numbers, origin=(0.0, 0.0, 0.0)):
    """A row-major map, from a frame whose 0 is at `origin`."""
    rows = [numbers[4 * row:4 * row + 4] for row in range(4)]
    for row in rows[:3]:
        row[3] += sum(factor * x for factor, x in zip(row, origin))
    return Matrix(rows)


def _empty_the_file():
    for items in (bpy.data.objects, bpy.data.collections, bpy.data.meshes, bpy.data.materials,
                  bpy.data.lights, bpy.data.cameras, bpy.data.worlds, bpy.data.images):
        for item in list(items):
            items.remove(item)
