"""The scene that was rendered, as a file to open in Blender."""

import bpy


def save_scene(output):
    """Saves it beside the passes, with its images in it, so that it can be looked at anywhere."""
    bpy.ops.file.pack_all()
    bpy.ops.wm.save_as_mainfile(filepath=output + ".blend", copy=True, compress=True, check_existing=False)
