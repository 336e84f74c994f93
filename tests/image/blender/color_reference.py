"""Renders one picture of extreme colours and saves it as Blender itself would show it.

    blender --background --factory-startup --python-exit-code 3 --python color_reference.py -- FOLDER

Writes into FOLDER:
  passes.exr      the multilayer EXR of one render: Combined as half, index, depth, normal
  NN.png          of the same render, one 8-bit PNG for each view, look, exposure and gamma
  references.txt  a line for each PNG: file, view, look, exposure, gamma, with tabs between
  config.txt      the path of Blender's own OCIO config
"""

import os
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "blender_scripts"))
import blender_versions  # noqa: E402

WIDTH, HEIGHT = 320, 240
# Seen by a camera at the origin that looks down -z: a chart of colours, and a tilted grey plane in
# front of it. What neither covers is background.
CHART_ID, CHART_DISTANCE_M, CHART_STOPS = 7, 4.0, (-10.0, 4.33)  # 2^4.33 = 20
TILTED_ID, TILT_RADIANS = 300, 0.5

EXPOSURES_AND_GAMMAS = ((0.0, 1.0), (1.0, 1.0), (-1.5, 1.2))
VIEWS_AND_LOOKS = (("Standard", "Medium High Contrast"), ("Filmic", "Medium High Contrast"),
                   ("AgX", "AgX - Medium High Contrast"))  # AgX since Blender 4.0


def emission_material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    emission = nodes.new("ShaderNodeEmission")
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    return nodes, links, emission, material


def math(nodes, links, operation, first, second):
    node = nodes.new("ShaderNodeMath")
    node.operation = operation
    for socket, value in zip(node.inputs, (first, second)):
        if isinstance(value, (int, float)):
            socket.default_value = value
        else:
            links.new(value, socket)
    return node.outputs["Value"]


def chart_material():
    """Hue grows along u, strength in stops along v; saturation cycles through 0, 1/3, 2/3 and 1."""
    nodes, links, emission, material = emission_material("chart")
    coordinates = nodes.new("ShaderNodeTexCoord")
    split = nodes.new("ShaderNodeSeparateXYZ")
    links.new(coordinates.outputs["UV"], split.inputs["Vector"])
    bands = math(nodes, links, "MULTIPLY", split.outputs["X"], 64.0)
    step = math(nodes, links, "MODULO", math(nodes, links, "FLOOR", bands, 0.0), 4.0)
    color = nodes.new("ShaderNodeCombineColor")
    color.mode = "HSV"
    links.new(split.outputs["X"], color.inputs[0])
    links.new(math(nodes, links, "DIVIDE", step, 3.0), color.inputs[1])
    color.inputs[2].default_value = 1.0
    links.new(color.outputs["Color"], emission.inputs["Color"])
    low, high = CHART_STOPS
    stops = math(nodes, links, "ADD",
                 math(nodes, links, "MULTIPLY", split.outputs["Y"], high - low), low)
    links.new(math(nodes, links, "POWER", 2.0, stops), emission.inputs["Strength"])
    return material


def grey_material():
    _, _, emission, material = emission_material("grey")
    emission.inputs["Color"].default_value = (0.18, 0.18, 0.18, 1.0)
    return material


def add_plane(size, location, rotation, index, material):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    plane = bpy.context.object
    plane.pass_index = index
    plane.data.materials.append(material)


def build_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.resolution_percentage = 100
    scene.render.dither_intensity = 0.0
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0.0, 0.0, 0.0)

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera

    add_plane(2.1, (0.0, 0.0, -CHART_DISTANCE_M), (0.0, 0.0, 0.0), CHART_ID, chart_material())
    add_plane(0.4, (0.4, 0.3, -2.0), (0.0, TILT_RADIANS, 0.0), TILTED_ID, grey_material())

    layer = scene.view_layers[0]
    layer.use_pass_object_index = True
    layer.use_pass_z = True
    layer.use_pass_normal = True
    return scene


def render_passes(scene, path):
    image = scene.render.image_settings
    blender_versions.set_multilayer_file(image)
    image.color_depth = "16"
    image.exr_codec = "ZIP"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def save_references(scene, folder):
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # Blender 5.0
        image.media_type = "IMAGE"
    image.file_format = "PNG"
    image.color_mode = "RGB"
    image.color_depth = "8"
    rows = []
    for view, contrast in VIEWS_AND_LOOKS[:2 if bpy.app.version < (4, 0, 0) else 3]:
        for look in ("None", contrast):
            for exposure, gamma in EXPOSURES_AND_GAMMAS:
                scene.view_settings.view_transform = view
                scene.view_settings.look = look
                scene.view_settings.exposure = exposure
                scene.view_settings.gamma = gamma
                name = f"{len(rows):02}.png"
                bpy.data.images["Render Result"].save_render(os.path.join(folder, name), scene=scene)
                rows.append(f"{name}\t{view}\t{look}\t{exposure}\t{gamma}\n")
    with open(os.path.join(folder, "references.txt"), "w", encoding="utf-8") as table:
        table.writelines(rows)


def write_config_path(folder):
    # A distribution keeps Blender's data apart, an unpacked download beside the program.
    places = (bpy.utils.system_resource("DATAFILES"),
              os.path.join(bpy.utils.resource_path("LOCAL"), "datafiles"))
    configs = [os.path.join(place, "colormanagement", "config.ocio") for place in places]
    with open(os.path.join(folder, "config.txt"), "w", encoding="utf-8") as text:
        text.write(next(config for config in configs if os.path.isfile(config)))


def main():
    folder = sys.argv[sys.argv.index("--") + 1]
    scene = build_scene()
    render_passes(scene, os.path.join(folder, "passes.exr"))
    save_references(scene, folder)
    write_config_path(folder)


main()
