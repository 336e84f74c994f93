"""Materials of the frame spec as node trees that all instances of a mesh share.

Cycles shares a mesh between objects only if none of them has materials of its own. So what differs
between instances is in custom properties of the objects, which Attribute nodes read: the values, and
which of several sets of images an instance wears (its look). Building a tree costs milliseconds, so
trees are kept by their shape, and each frame sets the images of those that it uses.
"""

import bpy

from bounded_cache import BoundedCache

MAX_LOOKS = 2_000  # of all trees that are kept
TEXTURES = ("alpha", "color", "metallic", "normal", "roughness")
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


def look_of(spec):
    """What of a material is in the tree: its images, sorted by their use."""
    unknown = set(spec["textures"]) - set(TEXTURES)
    if unknown:
        raise ValueError(f"unknown texture {sorted(unknown)}; there are {TEXTURES}")
    return tuple(sorted(spec["textures"].items()))


def set_values(item, slot, spec, look_index):
    """What of a material is in the object, for _Values to read."""
    red, green, blue = spec["base_color"]
    first, second, third = _property_names(slot)
    item[first] = (red, green, blue, spec["metallic"])
    item[second] = (spec["roughness"], spec["specular"], spec["transmission"], spec["ior"])
    item[third] = (spec["clearcoat"], spec["texture_repeat"], float(look_index), 0.0)


def _property_names(slot):
    return f"material{slot}.color", f"material{slot}.surface", f"material{slot}.look"


class MaterialPool:
    def __init__(self, images):
        self._images = images
        self._trees = BoundedCache(MAX_LOOKS, lambda tree: bpy.data.materials.remove(tree.material))
        self._materials = {}  # (slot, looks) -> material of the present frame
        self._used = {}  # shape -> how many trees of it the present frame uses

    def next_frame(self):
        self._trees.next_frame()
        self._materials.clear()
        self._used.clear()

    def trim(self):
        self._trees.trim()

    def get(self, slot, looks, paths):
        """A material for a slot of a mesh whose instances wear these looks (sorted, each once)."""
        key = (slot, looks)
        if key not in self._materials:
            shape = (slot, tuple(tuple(use for use, _ in look) for look in looks))
            number = self._used.get(shape, 0)
            self._used[shape] = number + 1
            tree = self._trees.get((shape, number), lambda: (_Tree(*shape), len(looks)))
            tree.set_images(looks, self._images, paths)
            self._materials[key] = tree.material
        return self._materials[key]


class _Tree:
    """One material: a Principled shader for each look, and a choice between them."""

    def __init__(self, slot, structures):
        self.material = bpy.data.materials.new(f"material{slot}")
        self.material.use_nodes = True
        self._nodes = self.material.node_tree.nodes
        self._links = self.material.node_tree.links
        self._nodes.clear()
        self._values = _Values(self, slot)
        self._textures = []  # for each look: use -> node
        shaders = [self._add_look(structure) for structure in structures]
        output = self.add("ShaderNodeOutputMaterial")
        self.link(self._choice(shaders, 0), output.inputs["Surface"])

    def set_images(self, looks, images, paths):
        for look, nodes in zip(looks, self._textures):
            for use, sha256 in look:
                image = images.get(sha256, "color" if use == "color" else "data", paths)
                if nodes[use].image != image:
                    nodes[use].image = image

    def add(self, kind):
        return self._nodes.new(kind)

    def link(self, output, socket):
        self._links.new(output, socket)

    def _choice(self, shaders, first):
        """The shader whose number the object names: halved until one is left. Cycles skips the half
        that has no weight."""
        if len(shaders) == 1:
            return shaders[0]
        half = len(shaders) // 2
        upper = self.add("ShaderNodeMath")
        upper.operation = "GREATER_THAN"
        upper.inputs[1].default_value = first + half - 0.5
        self.link(self._values.look_index, upper.inputs[0])
        mix = self.add("ShaderNodeMixShader")
        self.link(upper.outputs["Value"], mix.inputs[0])
        self.link(self._choice(shaders[:half], first), mix.inputs[1])
        self.link(self._choice(shaders[half:], first + half), mix.inputs[2])
        return mix.outputs[0]

    def _add_look(self, structure):
        principled = self.add("ShaderNodeBsdfPrincipled")
        textures = {use: self._add_texture() for use in structure}
        self._textures.append(textures)
        for name, value in self._values.scalars.items():
            source = textures[name].outputs["Color"] if name in textures else value
            self.link(source, _input(principled, _SCALARS[name]))
        color = self._values.color
        if "color" in textures:
            # A vector product is a colour product, by one node in every version of Blender.
            color = self.product("MULTIPLY", textures["color"].outputs["Color"], color)
        self.link(color, principled.inputs["Base Color"])
        if "normal" in textures:
            normal_map = self.add("ShaderNodeNormalMap")
            normal_map.uv_map = "UVMap"
            self.link(textures["normal"].outputs["Color"], normal_map.inputs["Color"])
            self.link(normal_map.outputs["Normal"], principled.inputs["Normal"])
        if "alpha" in textures:
            self.link(textures["alpha"].outputs["Color"], principled.inputs["Alpha"])
        return principled.outputs["BSDF"]

    def _add_texture(self):
        texture = self.add("ShaderNodeTexImage")
        texture.interpolation = "Linear"
        texture.extension = "REPEAT"
        self.link(self._values.uv(), texture.inputs["Vector"])
        return texture

    def product(self, operation, vector, factor):
        product = self.add("ShaderNodeVectorMath")
        product.operation = operation
        self.link(vector, product.inputs[0])
        self.link(factor, product.inputs["Scale"] if operation == "SCALE" else product.inputs[1])
        return product.outputs["Vector"]


class _Values:
    """The sockets of a tree that carry what set_values wrote."""

    def __init__(self, tree, slot):
        self._tree = tree
        first, second, third = (self._attribute(name) for name in _property_names(slot))
        self.color = first.outputs["Vector"]
        surface = self._parts(second)
        look = self._parts(third)
        self.scalars = {
            "metallic": first.outputs["Alpha"],
            "roughness": surface[0],
            "specular": surface[1],
            "transmission": surface[2],
            "ior": second.outputs["Alpha"],
            "clearcoat": look[0],
        }
        self._repeat, self.look_index = look[1], look[2]
        self._uv = None

    def uv(self):
        """UV coordinates times the repeats."""
        if self._uv is None:
            coordinates = self._tree.add("ShaderNodeTexCoord")
            self._uv = self._tree.product("SCALE", coordinates.outputs["UV"], self._repeat)
        return self._uv

    def _attribute(self, name):
        attribute = self._tree.add("ShaderNodeAttribute")
        attribute.attribute_type = "OBJECT"
        attribute.attribute_name = name
        return attribute

    def _parts(self, attribute):
        parts = self._tree.add("ShaderNodeSeparateXYZ")
        self._tree.link(attribute.outputs["Vector"], parts.inputs[0])
        return parts.outputs


def _input(principled, name):
    inputs = principled.inputs
    return inputs[name] if name in inputs else inputs[_SOCKET_IN_4_0[name]]
