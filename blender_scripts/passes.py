"""Render settings, passes and the file they go to."""

import os

import bpy

import blender_versions
import render_devices


def sharp_output(output):
    """Where the passes without depth of field go, beside those with it."""
    return output + ".sharp"


class PassRenderer:
    def __init__(self, scene, persistent_data=False, device="cpu"):
        """With persistent data, pixels depend on the frames before."""
        self._scene = scene
        self._view_layer = scene.view_layers[0]
        _set_constants(scene)
        scene.render.use_persistent_data = persistent_data
        scene.cycles.device = "CPU" if device == "cpu" else "GPU"

    def render(self, settings, output, frame_id, sample_counts=False):
        """Writes the passes of the present scene to `output`, with the id in the header's "Note".

        `sample_counts` asks for one more pass, which changes no other.
        """
        render, cycles = self._scene.render, self._scene.cycles
        render.stamp_note_text = frame_id
        render.resolution_x = settings["width"]
        render.resolution_y = settings["height"]
        _set_region(render, settings)
        render.filepath = output
        cycles.samples = settings["samples"]
        cycles.seed = settings["seed"]
        _set_adaptive(cycles, settings.get("adaptive"))
        _set_denoiser(cycles, settings["denoise"])
        cycles.filter_width = settings["filter_width_px"]
        cycles.sample_clamp_indirect = settings["clamp_indirect"]
        _set_levers(self._scene, settings["max_bounces"], settings.get("levers", {}))
        self._view_layer.use_pass_z = settings["depth"]
        self._view_layer.use_pass_normal = settings["normal"]
        self._view_layer.cycles.pass_debug_sample_count = sample_counts

        if os.path.lexists(output):
            os.remove(output)  # or an old file could pass for this one
        bpy.ops.render.render(write_still=True)
        if not os.path.isfile(output):
            raise RuntimeError(f"Blender wrote no {output}: is the disk full, or its folder missing?")


def _set_constants(scene):
    """What is the same for every frame. Cycles' defaults change between versions: none is relied on
    where it shows."""
    render = scene.render
    render.engine = "CYCLES"
    render.resolution_percentage = 100
    render.film_transparent = False
    render.dither_intensity = 0.0
    render.use_motion_blur = False
    render.simplify_subdivision_render = 0
    render.simplify_child_particles_render = 0.0
    render.use_compositing = False
    render.use_sequencer = False
    _set_cycles(scene.cycles)
    _set_output(render)
    # Exposure and view are ImageSettings and belong to the scheduler.
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    view_layer = scene.view_layers[0]
    view_layer.use_pass_combined = True
    view_layer.use_pass_object_index = True
    view_layer.pass_alpha_threshold = 0.5  # where a texture cuts holes, labels look through them


def _set_cycles(cycles):
    cycles.time_limit = 0.0
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.caustics_reflective = False
    cycles.caustics_refractive = False
    cycles.use_fast_gi = False
    cycles.use_auto_tile = False
    blender_versions.set_sampling(cycles)


def _set_levers(scene, max_bounces, levers):
    cycles = scene.cycles
    bounces = levers.get("bounces", {})
    cycles.max_bounces = cycles.volume_bounces = max_bounces
    cycles.diffuse_bounces = bounces.get("diffuse", max_bounces)
    cycles.glossy_bounces = bounces.get("glossy", max_bounces)
    cycles.transmission_bounces = bounces.get("transmission", max_bounces)
    cycles.transparent_max_bounces = bounces.get("transparent", max_bounces)
    cycles.light_sampling_threshold = levers.get("light_threshold", 0.0)
    cycles.sample_clamp_direct = levers.get("clamp_direct", 0.0)
    cycles.blur_glossy = levers.get("filter_glossy", 0.0)
    blender_versions.set_path_guiding(cycles, levers.get("path_guiding", False))
    # Textures are limited as part of "simplifying", of which nothing else is used.
    limit = levers.get("texture_limit_px", 0)
    scene.render.use_simplify = limit > 0
    cycles.texture_limit_render = str(limit) if limit > 0 else "OFF"


def _set_region(render, settings):
    """Only these pixels of the image are rendered and written; each is what it is in the whole image."""
    region = settings.get("region")
    render.use_border = render.use_crop_to_border = region is not None
    if region:
        x, y, width, height = region
        # Shares of the image, from its lower left corner. Blender rounds their products with its size
        # down, in float32: half a pixel more keeps that right.
        render.border_min_x = (x + 0.5) / settings["width"]
        render.border_max_x = (x + width + 0.5) / settings["width"]
        render.border_min_y = (settings["height"] - y - height + 0.5) / settings["height"]
        render.border_max_y = (settings["height"] - y + 0.5) / settings["height"]


def _set_adaptive(cycles, adaptive):
    cycles.use_adaptive_sampling = adaptive is not None
    if adaptive:
        cycles.adaptive_threshold = adaptive["threshold"]
        cycles.adaptive_min_samples = adaptive["min_samples"]


def _set_denoiser(cycles, denoise):
    cycles.use_denoising = denoise != "off"
    if cycles.use_denoising:
        if "OpenImageDenoise" not in render_devices.denoisers():
            raise ValueError("this Blender has no Open Image Denoise")
        cycles.denoiser = "OPENIMAGEDENOISE"
        cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"
        cycles.denoising_prefilter = "FAST" if denoise == "oidn_fast" else "ACCURATE"


def _set_output(render):
    image = render.image_settings
    blender_versions.set_multilayer_file(image)
    image.color_mode = "RGBA"
    image.color_depth = "16"  # half for Combined; data passes are float all the same
    image.exr_codec = "ZIP"
    render.use_overwrite = True
    render.use_file_extension = False
    render.use_placeholder = False
    for stamp in ("time", "date", "frame", "frame_range", "camera", "lens", "scene", "marker",
                  "filename", "sequencer_strip", "render_time", "memory", "hostname"):
        setattr(render, f"use_stamp_{stamp}", False)
    render.use_stamp_note = True
