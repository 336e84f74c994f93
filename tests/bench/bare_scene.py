"""Frames in Blender as somebody writes them who knows Blender well and has one script for one dataset.

Meshes, images, objects and materials are made once and used again; each object has its own material,
because its colours are its own; Blender's settings are what they are. Nothing is taken from the
workers' code: this is what they are compared with (bare_loop.py).
"""

import bpy
from mathutils import Matrix, Vector

_INPUTS = {"metallic": ("Metallic",), "roughness": ("Roughness",),
           "specular": ("Specular", "Specular IOR Level"),
           "transmission": ("Transmission", "Transmission Weight"), "ior": ("IOR",),
           "clearcoat": ("Clearcoat", "Coat Weight")}
_LIGHTS = {"point": "POINT", "sun": "SUN", "spot": "SPOT", "area": "AREA"}


class BareScene:
    def __init__(self, load_mesh, image_paths):
        self._load_mesh = load_mesh  # sha256 -> Blender mesh
        self._image_paths = image_paths
        self._meshes, self._images, self._materials, self._objects, self._lights = {}, {}, {}, [], {}
        for item in list(bpy.data.objects):
            bpy.data.objects.remove(item)
        self.scene = bpy.context.scene
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        self.scene.collection.objects.link(camera)
        self.scene.camera = camera
        world = self.scene.world = bpy.data.worlds.new("world")
        world.use_nodes = True
        self._world = world.node_tree
        self._environment = None
        _set_up(self.scene)

    def render(self, spec, output):
        self._set_camera(spec["camera"], spec["render"])
        self._set_world(spec["world"])
        for index, instance in enumerate(spec["instances"]):
            self._place(index, instance, spec["materials"])
        for item in self._objects[len(spec["instances"]):]:
            item.hide_render = True
        self._set_lights(spec["lights"])
        render = self.scene.render
        render.resolution_x, render.resolution_y = spec["render"]["width"], spec["render"]["height"]
        render.filepath = output
        cycles = self.scene.cycles
        cycles.samples, cycles.seed = spec["render"]["samples"], spec["render"]["seed"]
        cycles.max_bounces = spec["render"]["max_bounces"]
        self.scene.view_layers[0].use_pass_z = spec["render"]["depth"]
        self.scene.view_layers[0].use_pass_normal = spec["render"]["normal"]
        bpy.ops.render.render(write_still=True)

    def _set_camera(self, spec, render):
        data = self.scene.camera.data
        data.lens = spec["focal_px"][0] * data.sensor_width / render["width"]
        data.clip_start, data.clip_end = spec["clip_start_m"], spec["clip_end_m"]

    def _set_world(self, spec):
        background = self._world.nodes["Background"]
        background.inputs["Strength"].default_value = spec["strength"]
        if "hdri" not in spec:
            background.inputs["Color"].default_value = (*spec["color"], 1.0)
            return
        if self._environment is None:
            self._environment = self._world.nodes.new("ShaderNodeTexEnvironment")
            self._turn = self._world.nodes.new("ShaderNodeMapping")
            coordinates = self._world.nodes.new("ShaderNodeTexCoord")
            self._world.links.new(coordinates.outputs["Generated"], self._turn.inputs["Vector"])
            self._world.links.new(self._turn.outputs["Vector"], self._environment.inputs["Vector"])
            self._world.links.new(self._environment.outputs["Color"], background.inputs["Color"])
        self._environment.image = self._image(spec["hdri"], None)
        turn = spec["map_from_camera"]
        rotation = Matrix((turn[0:3], turn[3:6], turn[6:9])).to_euler()
        self._turn.inputs["Rotation"].default_value = rotation

    def _place(self, index, spec, materials):
        mesh = self._meshes.get(spec["mesh"])
        if mesh is None:
            mesh = self._meshes[spec["mesh"]] = self._load_mesh(spec["mesh"])
        if index == len(self._objects):
            self._objects.append(bpy.data.objects.new(f"object.{index}", mesh))
            self.scene.collection.objects.link(self._objects[-1])
        item = self._objects[index]
        item.data, item.hide_render, item.pass_index = mesh, False, spec["id"]
        item.matrix_world = _matrix(spec["camera_from_object"])
        for slot, number in zip(item.material_slots, spec["materials"]):
            slot.link = "OBJECT"
            slot.material = self._material((index, slot.slot_index), materials[number])

    def _material(self, owner, spec):
        key = (owner, tuple(sorted(spec["textures"])))
        if key not in self._materials:
            self._materials[key] = self._new_material(spec["textures"])
        material, principled, images, repeat, tint = self._materials[key]
        for use, node in images.items():
            node.image = self._image(spec["textures"][use], "sRGB" if use == "color" else "Non-Color")
        if repeat:
            repeat.default_value = Vector((1, 1, 1)) * spec["texture_repeat"]
        if tint:
            tint.default_value = spec["base_color"]
        else:
            principled.inputs["Base Color"].default_value = (*spec["base_color"], 1.0)
        for name in _INPUTS:
            if name not in images:
                _socket(principled, name).default_value = spec[name]
        return material

    def _new_material(self, textures):
        material = bpy.data.materials.new("material")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        principled = nodes["Principled BSDF"]
        images, repeat, tint = {}, None, None
        if textures:
            mapping = nodes.new("ShaderNodeMapping")
            links.new(nodes.new("ShaderNodeTexCoord").outputs["UV"], mapping.inputs["Vector"])
            repeat = mapping.inputs["Scale"]
        for use in sorted(textures):
            node = images[use] = nodes.new("ShaderNodeTexImage")
            links.new(mapping.outputs["Vector"], node.inputs["Vector"])
            color = node.outputs["Color"]
            if use == "color":
                product = nodes.new("ShaderNodeVectorMath")
                product.operation = "MULTIPLY"
                links.new(color, product.inputs[0])
                links.new(product.outputs["Vector"], principled.inputs["Base Color"])
                tint = product.inputs[1]
            elif use == "normal":
                normal_map = nodes.new("ShaderNodeNormalMap")
                links.new(color, normal_map.inputs["Color"])
                links.new(normal_map.outputs["Normal"], principled.inputs["Normal"])
            elif use == "alpha":
                links.new(color, principled.inputs["Alpha"])
            else:
                links.new(color, _socket(principled, use))
        return material, principled, images, repeat, tint

    def _image(self, sha256, color_space):
        if sha256 not in self._images:
            self._images[sha256] = bpy.data.images.load(self._image_paths[sha256])
            if color_space:
                self._images[sha256].colorspace_settings.name = color_space
        return self._images[sha256]

    def _set_lights(self, specs):
        for item in self._lights.values():
            item.hide_render = True
        for index, spec in enumerate(specs):
            key = (index, spec["kind"])
            if key not in self._lights:
                self._lights[key] = bpy.data.objects.new("light", bpy.data.lights.new("light", _LIGHTS[spec["kind"]]))
                self.scene.collection.objects.link(self._lights[key])
            item = self._lights[key]
            item.hide_render = False
            item.matrix_world = _matrix(spec["camera_from_light"])
            item.data.color, item.data.energy = spec["color"], spec["power"]
            if spec["kind"] == "area":
                item.data.shape, item.data.size, item.data.size_y = "RECTANGLE", spec["width_m"], spec["height_m"]
            elif spec["kind"] == "sun":
                item.data.angle = spec["angle_rad"]
            else:
                item.data.shadow_soft_size = spec["radius_m"]
            if spec["kind"] == "spot":
                item.data.spot_size, item.data.spot_blend = spec["angle_rad"], spec["blend"]


def _set_up(scene):
    scene.render.engine = "CYCLES"
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    layer = scene.view_layers[0]
    layer.use_pass_object_index = True
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # Blender 5
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth = "16"
    image.exr_codec = "ZIP"


def _socket(principled, name):
    return next(principled.inputs[known] for known in _INPUTS[name] if known in principled.inputs)


def _matrix(numbers):
    return Matrix((numbers[0:4], numbers[4:8], numbers[8:12], numbers[12:16]))
