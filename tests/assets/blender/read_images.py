"""Reads images as a worker does, and writes what Cycles renders of each.

blender --background --python read_images.py -- LIST, where each line of LIST is a use of blender_scripts/image_cache.py,
a tab and a file. Beside the file comes <file>.<use>: a line with width, height and colour space, and then the pixels,
float RGB, row 0 on top: a plane that glows with the image, one of its pixels for each of the picture's. An image that
Blender cannot read leaves no such file.
"""

import pathlib
import sys

import bpy
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "blender_scripts"))
from image_cache import ImageCache  # noqa: E402


def plane_that_glows():
    """The node that takes the image."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_plane_add(size=1)
    material = bpy.data.materials.new("glow")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    texture, glow = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeEmission")
    texture.interpolation = "Closest"
    links.new(texture.outputs["Color"], glow.inputs["Color"])
    links.new(glow.outputs["Emission"], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    bpy.context.object.data.materials.append(material)
    return texture


def camera_above():
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", 1
    thing = bpy.data.objects.new("camera", camera)
    thing.location.z = 1
    scene = bpy.context.scene
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"


def rendered(width, height, path):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    longest = max(width, height)
    bpy.context.object.scale = (width / longest, height / longest, 1)
    scene.render.filepath = path + ".exr"
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath)
    pixels = numpy.empty(width * height * picture.channels, dtype=numpy.float32)
    picture.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, picture.channels)[::-1, :, :3]


def read(use, path, texture):
    try:
        image = ImageCache().get("sha256", use, {"sha256": path})
    except (ValueError, RuntimeError) as error:
        print(f"{path}: {error}")
        return
    width, height = image.size
    texture.image = image
    pixels = rendered(width, height, f"{path}.{use}")
    with open(f"{path}.{use}", "wb") as out:
        out.write(f"{width} {height} {image.colorspace_settings.name}\n".encode())
        out.write(numpy.ascontiguousarray(pixels).tobytes())


def main():
    texture = plane_that_glows()
    plane = bpy.context.object
    camera_above()
    bpy.context.view_layer.objects.active = plane
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as lines:
        for line in lines:
            read(*line.rstrip("\n").split("\t"), texture)


main()
