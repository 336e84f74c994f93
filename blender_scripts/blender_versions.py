"""What differs between the versions of Blender that a worker may run in; docs/blender_versions.md has the
rest. Nothing else in these scripts depends on a version.

What can be seen in Blender itself is not looked up by its number.
"""

import math

# Kernels of Cycles for instructions that the CPU may have, least first: name, how Cycles calls the
# instructions, and the variable that forbids the kernel. Before them is one for any CPU that this
# Blender runs on.
_KERNELS = {
    (3, 0): ("generic", (("sse2", "SSE2", "CYCLES_CPU_NO_SSE2"),
                         ("sse3", "SSE3", "CYCLES_CPU_NO_SSE3"),
                         ("sse41", "SSE41", "CYCLES_CPU_NO_SSE41"),
                         ("avx", "AVX", "CYCLES_CPU_NO_AVX"),
                         ("avx2", "AVX2", "CYCLES_CPU_NO_AVX2"))),
    (4, 0): ("generic", (("sse2", "SSE2", "CYCLES_CPU_NO_SSE2"),
                         ("sse41", "SSE41", "CYCLES_CPU_NO_SSE41"),
                         ("avx2", "AVX2", "CYCLES_CPU_NO_AVX2"))),
    (4, 2): ("generic", (("sse42", "SSE42", "CYCLES_CPU_NO_SSE42"),
                         ("avx2", "AVX2", "CYCLES_CPU_NO_AVX2"))),
    (4, 3): ("sse42", (("avx2", "AVX2", "CYCLES_CPU_NO_AVX2"),)),
}

# "Linear" is linear Rec.709; Blender 4 calls it so.
_COLOR_SPACES = {
    "color": ("sRGB",),
    "data": ("Non-Color",),
    "environment": ("Linear", "Linear Rec.709"),
}


# Inputs of the Principled BSDF by their names before 4.0, which renamed them.
_PRINCIPLED_SINCE_4_0 = {
    "Specular": "Specular IOR Level",
    "Transmission": "Transmission Weight",
    "Clearcoat": "Coat Weight",
    "Subsurface": "Subsurface Weight",
}


def kernels(version):
    """The kernel of Cycles for any CPU, and the others, least first."""
    return _KERNELS[max(first for first in _KERNELS if first <= tuple(version[:2]))]


def set_color_space(image, use):
    """That of a file for one of the uses in _COLOR_SPACES."""
    for name in _COLOR_SPACES[use]:
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # this Blender has no such colour space
            continue
    raise ValueError(f"this Blender has none of the colour spaces {_COLOR_SPACES[use]}")


def principled_input(node, name):
    """An input of a Principled BSDF by its name before Blender 4.0."""
    return node.inputs[name] if name in node.inputs else node.inputs[_PRINCIPLED_SINCE_4_0[name]]


def area_light_factor(version):
    """What Blender's power of an area light is for a watt that leaves it: before 4.0 Cycles divided by 4
    where it is π, so such lights were too dark."""
    return 1.0 if tuple(version) >= (4, 0, 0) else 4.0 / math.pi


def set_loop_totals(mesh, totals):
    """How many corners each polygon has."""
    polygons = mesh.polygons
    if not polygons[0].bl_rna.properties["loop_total"].is_readonly:  # 3.6 finds it by itself
        polygons.foreach_set("loop_total", totals)


def sharpen(mesh, angle):
    """Makes edges sharp whose faces are at more than an angle to each other."""
    if hasattr(mesh, "set_sharp_from_angle"):  # 4.1
        mesh.set_sharp_from_angle(angle=angle)
        return
    # With auto smooth on, Cycles would split the mesh at its sharp edges anew for each frame, which takes as
    # long as all its other work on it. Split once, smooth shading gives the same picture.
    mesh.use_auto_smooth = True
    mesh.auto_smooth_angle = angle
    mesh.calc_normals_split()
    mesh.split_faces()
    mesh.use_auto_smooth = False


def set_multilayer_file(image_settings):
    """One part that holds all passes."""
    if hasattr(image_settings, "media_type"):  # 5.0
        image_settings.media_type = "MULTI_LAYER_IMAGE"
    image_settings.file_format = "OPEN_EXR_MULTILAYER"
    if hasattr(image_settings, "use_exr_interleave"):  # 5.0, which else writes a part for each pass
        image_settings.use_exr_interleave = True


def set_path_guiding(cycles, wanted):
    if hasattr(cycles, "use_guiding"):  # 3.4
        cycles.use_guiding = wanted
    elif wanted:
        raise ValueError("this Blender has no path guiding, which came with 3.4")


def set_sampling(cycles):
    """Of how light is sampled, what some versions lack."""
    if hasattr(cycles, "use_light_tree"):  # 3.5
        cycles.use_light_tree = True
