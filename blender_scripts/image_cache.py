"""Texture files as Blender images."""

import bpy

import blender_versions
from bounded_cache import BoundedCache

MAX_PIXELS = 64_000_000  # of all cached images; Blender holds 4 bytes of each, 16 for float images


class ImageCache:
    def __init__(self, max_pixels=MAX_PIXELS):
        self._cache = BoundedCache(max_pixels, bpy.data.images.remove)

    def next_frame(self):
        self._cache.next_frame()

    def trim(self):
        self._cache.trim()

    def get(self, sha256, use, paths):
        """An image to be used as "color", "data" or "environment"."""
        # The colour space belongs to Blender's image, so one file may be several of them.
        return self._cache.get((sha256, use), lambda: _load(sha256, use, paths))


# Their colours are linear as they are; those of all other files are sRGB.
_LINEAR_ENDINGS = (".exr", ".hdr")


def _load(sha256, use, paths):
    if sha256 not in paths:
        raise ValueError(f"texture {sha256} is in the frame spec but not in the request's table")
    path = paths[sha256]
    image = bpy.data.images.load(path, check_existing=False)
    width, height = image.size  # reads the file's header; 0 if it is no image
    if width == 0 or height == 0:
        bpy.data.images.remove(image)
        raise ValueError(f"{path}: no image that Blender can read")
    if use == "color" and path.lower().endswith(_LINEAR_ENDINGS):
        use = "environment"
    blender_versions.set_color_space(image, use)
    image.alpha_mode = "NONE"
    return image, width * height
