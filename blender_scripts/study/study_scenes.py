"""The scenes of the determinism study: one for each kind of light transport. No randomness; what moves
is a function of the frame."""

import math

import bpy

import blender_versions

SIDE_M = 4.0


def build(name):
    """Replaces everything by the scene; returns it. `move` then sets a frame."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.05
    _add_camera(scene)
    bpy.ops.mesh.primitive_plane_add(size=SIDE_M)
    bpy.context.object.data.materials.append(_principled("ground", base=(0.4, 0.38, 0.35, 1), roughness=0.8))
    _add_heads(_MATERIALS.get(name, _diffuse)())
    if name != "many lights":
        _add_area_light()
    _EXTRAS.get(name, lambda scene: None)(scene)
    return scene


def move(scene, frame):
    scene.frame_set(frame)
    for index, head in enumerate(_heads()):
        head.rotation_euler = (0.2 * index, 0.1 * frame, 0.4 * frame + index)
        head.location.x = -1.0 + index + 0.05 * frame
        head.hide_render = index == 2 and frame % 2 == 0


def _heads():
    return [item for item in bpy.data.objects if item.name.startswith("head")]


def _add_camera(scene):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0.0, -4.2, 2.6)
    camera.rotation_euler = (math.radians(60), 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera


def _add_heads(material):
    """Three smooth heads of 7,900 triangles, and their labels."""
    for index in range(3):
        bpy.ops.mesh.primitive_monkey_add(size=0.9, location=(-1.0 + index, 0.0, 0.6))
        head = bpy.context.object
        head.name = f"head{index}"
        head.pass_index = index + 1
        bpy.ops.object.shade_smooth()
        subdivision = head.modifiers.new("subdivision", "SUBSURF")
        subdivision.render_levels = subdivision.levels = 1
        head.data.materials.append(material)


def _add_area_light():
    light = bpy.data.lights.new("key", "AREA")
    light.energy, light.size = 120.0, 1.0
    key = bpy.data.objects.new("key", light)
    key.location, key.rotation_euler = (2.0, -2.0, 3.0), (math.radians(40), 0.0, math.radians(40))
    bpy.context.scene.collection.objects.link(key)


def _principled(name, base=(0.7, 0.3, 0.1, 1), **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = base
    for key, value in inputs.items():
        blender_versions.principled_input(node, key.title()).default_value = value
    return material


def _diffuse():
    return _principled("diffuse", roughness=1.0, specular=0.0)


def _add_volume(scene):
    bpy.ops.mesh.primitive_cube_add(size=2.6, location=(0, 0, 1.0))
    material = bpy.data.materials.new("fog")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.remove(nodes["Principled BSDF"])
    fog = nodes.new("ShaderNodeVolumePrincipled")
    fog.inputs["Density"].default_value = 0.4
    material.node_tree.links.new(fog.outputs[0], nodes["Material Output"].inputs["Volume"])
    bpy.context.object.data.materials.append(material)


def _add_hair(scene):
    for head in _heads():
        modifier = head.modifiers.new("hair", "PARTICLE_SYSTEM")
        settings = modifier.particle_system.settings
        settings.type = "HAIR"
        settings.count = 800
        settings.hair_length = 0.15
        modifier.particle_system.seed = 1


def _add_many_lights(scene):
    for index in range(64):
        light = bpy.data.lights.new(f"light{index}", "POINT")
        light.energy = 4.0
        light.color = [(0.6 + 0.4 * math.sin(index + shift)) for shift in (0.0, 2.0, 4.0)]
        item = bpy.data.objects.new(light.name, light)
        item.location = (-1.75 + 0.5 * (index % 8), -1.75 + 0.5 * (index // 8), 2.0)
        scene.collection.objects.link(item)


def _open_lens(scene):
    scene.camera.data.dof.use_dof = True
    scene.camera.data.dof.focus_distance = 4.0
    scene.camera.data.dof.aperture_fstop = 0.3


def _blur(scene):
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = 0.5
    for index, head in enumerate(_heads()):
        for frame in (0, 10):
            head.location.z = 0.6 + 0.08 * frame * (index + 1)
            head.keyframe_insert("location", index=2, frame=frame)


_MATERIALS = {
    "glossy": lambda: _principled("glossy", metallic=1.0, roughness=0.15),
    "glass": lambda: _principled("glass", base=(1, 1, 1, 1), transmission=1.0, roughness=0.05),
    "subsurface": lambda: _principled("subsurface", subsurface=0.6),
}
_EXTRAS = {
    "volumes": _add_volume,
    "hair": _add_hair,
    "many lights": _add_many_lights,
    "depth of field": _open_lens,
    "motion blur": _blur,
}
