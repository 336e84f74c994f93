"""Materials of the frame spec as Principled node trees.

Building a node tree costs milliseconds, setting its values microseconds. So trees are kept by their
structure (which textures there are), and each frame overwrites every value of those that it uses.
"""

import bpy

_SOCKET_IN_4_0 = {
    "Specular": "Specular IOR Level",
    "Transmission": "Transmission Weight",
    "Clearcoat": "Coat Weight",
}
_SCALARS = {
    "metallic": "Metallic",
    "roughness": "Roughness",
    "specular": "Specular",
    "transmission": "Transmission",
    "ior": "IOR",
    "clearcoat": "Clearcoat",
}
TEXTURES = ("alpha", "color", "metallic", "normal", "roughness")


class MaterialPool:
    def __init__(self, images):
        self._images = images
        self._trees = {}  # structure -> trees
        self._used = {}  # structure -> how many of them the present frame uses

    def next_frame(self):
        self._used.clear()

    def get(self, spec, paths):
        """A material with the values of `spec`, which no other material of this frame shares."""
        structure = tuple(sorted(spec["textures"]))
        unknown = set(structure) - set(TEXTURES)
        if unknown:
            raise ValueError(f"unknown texture {sorted(unknown)}; there are {TEXTURES}")
        trees = self._trees.setdefault(structure, [])
        index = self._used.get(structure, 0)
        self._used[structure] = index + 1
        if index == len(trees):
            trees.append(_Tree(structure))
        trees[index].set(spec, self._images, paths)
        return trees[index].material


class _Tree:
    """One material and the sockets of it that change."""

    def __init__(self, structure):
        self.material = bpy.data.materials.new("-".join(("material",) + structure))
        self.material.use_nodes = True
        self._nodes = self.material.node_tree.nodes
        self._links = self.material.node_tree.links
        self._nodes.clear()
        output = self._nodes.new("ShaderNodeOutputMaterial")
        self._principled = self._nodes.new("ShaderNodeBsdfPrincipled")
        self._links.new(self._principled.outputs["BSDF"], output.inputs["Surface"])
        self._base_color = self._input("Base Color")
        self._scalars = [(key, self._input(_SCALARS[key])) for key in _SCALARS if key not in structure]
        self._images = {}
        self._repeat = self._add_mapping() if structure else None
        for kind in structure:
            self._add_texture(kind)

    def set(self, spec, images, paths):
        red, green, blue = spec["base_color"]
        for key, socket in self._scalars:
            socket.default_value = spec[key]
        if "color" in self._images:
            self._base_color.default_value = (red, green, blue)
        else:
            self._base_color.default_value = (red, green, blue, 1.0)
        if self._repeat:
            self._repeat.default_value = (spec["texture_repeat"], spec["texture_repeat"], 1.0)
        for kind, node in self._images.items():
            node.image = images.get(spec["textures"][kind], "color" if kind == "color" else "data", paths)

    def _input(self, name):
        inputs = self._principled.inputs
        return inputs[name] if name in inputs else inputs[_SOCKET_IN_4_0[name]]

    def _add_mapping(self):
        coordinates = self._nodes.new("ShaderNodeTexCoord")
        mapping = self._nodes.new("ShaderNodeMapping")
        self._links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        self._uv = mapping.outputs["Vector"]
        return mapping.inputs["Scale"]

    def _add_texture(self, kind):
        texture = self._nodes.new("ShaderNodeTexImage")
        texture.interpolation = "Linear"
        texture.extension = "REPEAT"
        self._links.new(self._uv, texture.inputs["Vector"])
        self._images[kind] = texture
        color = texture.outputs["Color"]
        if kind == "color":
            # A vector product is a colour product, by one node in every version of Blender.
            multiply = self._nodes.new("ShaderNodeVectorMath")
            multiply.operation = "MULTIPLY"
            self._links.new(color, multiply.inputs[0])
            self._links.new(multiply.outputs["Vector"], self._base_color)
            self._base_color = multiply.inputs[1]
        elif kind == "normal":
            normal_map = self._nodes.new("ShaderNodeNormalMap")
            normal_map.uv_map = "UVMap"
            self._links.new(color, normal_map.inputs["Color"])
            self._links.new(normal_map.outputs["Normal"], self._input("Normal"))
        elif kind == "alpha":
            self._links.new(color, self._input("Alpha"))
        else:
            self._links.new(color, self._input(_SCALARS[kind]))
