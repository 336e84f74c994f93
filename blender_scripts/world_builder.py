"""The light from everywhere: one colour, or an environment map."""

import bpy


class WorldBuilder:
    def __init__(self, scene, images):
        self._images = images
        world = bpy.data.worlds.new("world")
        scene.world = world
        world.use_nodes = True
        world.cycles.sampling_method = "MANUAL"  # or the map of importance would have the image's size
        self._world = world
        self._tree = world.node_tree
        self._background = self._tree.nodes["Background"]
        self._rows = []  # of the matrix that turns directions of the camera into those of the map
        self._tint, self._texture = self._add_map()

    def set(self, spec, image_paths):
        self._background.inputs["Strength"].default_value = spec["strength"]
        for link in list(self._background.inputs["Color"].links):
            self._tree.links.remove(link)
        self._texture.image = None
        if "hdri" not in spec:
            self._background.inputs["Color"].default_value = (*spec["color"], 1.0)
            return
        self._world.cycles.sample_map_resolution = spec["importance_map_px"]
        self._texture.image = self._images.get(spec["hdri"], "environment", image_paths)
        for row, socket in enumerate(self._rows):
            socket.default_value = spec["map_from_camera"][3 * row:3 * row + 3]
        self._tint.inputs[1].default_value = spec["color"]
        self._tree.links.new(self._tint.outputs["Vector"], self._background.inputs["Color"])

    def _add_map(self):
        nodes, links = self._tree.nodes, self._tree.links
        coordinates = nodes.new("ShaderNodeTexCoord")
        combine = nodes.new("ShaderNodeCombineXYZ")
        for axis in range(3):
            # A row of the matrix times the direction: no Euler angles, nothing to round twice.
            product = nodes.new("ShaderNodeVectorMath")
            product.operation = "DOT_PRODUCT"
            links.new(coordinates.outputs["Generated"], product.inputs[0])
            links.new(product.outputs["Value"], combine.inputs[axis])
            self._rows.append(product.inputs[1])
        texture = nodes.new("ShaderNodeTexEnvironment")
        texture.projection = "EQUIRECTANGULAR"
        texture.interpolation = "Linear"
        links.new(combine.outputs["Vector"], texture.inputs["Vector"])
        tint = nodes.new("ShaderNodeVectorMath")
        tint.operation = "MULTIPLY"
        links.new(texture.outputs["Color"], tint.inputs[0])
        return tint, texture
