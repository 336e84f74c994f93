"""Materials of the frame spec as node trees that all instances of a mesh share.

Cycles shares a mesh between objects only if none of them has materials of its own. So what differs
between the instances of a mesh is in custom properties of the objects, which Attribute nodes read: the
values that vary, and which of several sets of images an instance wears (its look). What does not vary
is in the nodes, where it costs Cycles nothing. Building a tree costs milliseconds, so trees are kept by
their shape, and each frame sets the values and images of those that it uses.
"""

import collections

import bpy

from blender_versions import principled_input
from bounded_cache import BoundedCache

MAX_LOOKS = 2_000  # of all trees that are kept
TEXTURES = ("alpha", "color", "metallic", "normal", "roughness")
_SCALARS = {
    "metallic": "Metallic",
    "roughness": "Roughness",
    "specular": "Specular",
    "transmission": "Transmission",
    "ior": "IOR",
    "clearcoat": "Clearcoat",
}


class MaterialPool:
    def __init__(self, images):
        self._images = images
        self._trees = BoundedCache(MAX_LOOKS, lambda tree: bpy.data.materials.remove(tree.material))
        self._used = collections.Counter()  # shape -> how many trees of it the present frame uses

    def next_frame(self):
        self._trees.next_frame()
        self._used.clear()

    def trim(self):
        self._trees.trim()

    def get(self, slot, worn, paths):
        """A Wardrobe of these materials of the frame spec, for a slot of a mesh."""
        looks = _padded({_look_of(spec) for spec in worn})
        varying = tuple(name for name in ("base_color", *_SCALARS, "texture_repeat")
                        if any(spec[name] != worn[0][name] for spec in worn))
        shape = (slot, tuple(_uses(look) for look in looks), varying)
        number = self._used[shape]
        self._used[shape] += 1
        tree = self._trees.get((shape, number), lambda: (_Tree(*shape), len(looks)))
        tree.set_constants(worn[0])
        tree.set_images(looks, self._images, paths)
        return Wardrobe(tree, looks)


class Wardrobe:
    """The one material of a slot, and how an object wears one of the frame spec's by it."""

    def __init__(self, tree, looks):
        self.material = tree.material
        self._properties = tree.properties
        self._looks = looks

    def dress(self, item, spec):
        for name, values in self._properties.items():
            item[name] = [self._value(spec, value) for value in values]

    def _value(self, spec, value):
        name, axis = value
        if name == "look":
            return float(self._looks.index(_look_of(spec)))
        return spec[name] if axis is None else spec[name][axis]


def _look_of(spec):
    """What of a material is in the tree alone: its images, sorted by their use."""
    unknown = set(spec["textures"]) - set(TEXTURES)
    if unknown:
        raise ValueError(f"unknown texture {sorted(unknown)}; there are {TEXTURES}")
    return tuple(sorted(spec["textures"].items()))


def _uses(look):
    return tuple(use for use, _ in look)


def _padded(looks):
    """By structure, the last look of each repeated up to a round number: so frames that wear now 58 sets
    of images and now 61 share a tree. No object wears what is added, and Cycles skips it."""
    by_structure = collections.defaultdict(list)
    for look in sorted(looks, key=lambda look: (_uses(look), look)):
        by_structure[_uses(look)].append(look)
    return [look for group in by_structure.values()
            for look in group + group[-1:] * (_round_number(len(group)) - len(group))]


def _round_number(count):
    """Not below a count: a power of two up to 16, then a multiple of it."""
    return 1 << (count - 1).bit_length() if count < 16 else -(-count // 16) * 16


class _Tree:
    """One material: a Principled shader for each look, and a choice between them."""

    def __init__(self, slot, structures, varying):
        self.material = bpy.data.materials.new(f"material{slot}")
        self.material.use_nodes = True
        self._nodes = self.material.node_tree.nodes
        self._links = self.material.node_tree.links
        self._nodes.clear()
        self.properties = {}  # of an object: name -> four times which value
        self._varying = {}  # value -> the socket that carries it
        self._constants = collections.defaultdict(list)  # value -> sockets to be set
        self._present = {}  # value -> what those sockets are set to
        self._add_attributes(slot, varying + (("look",) if len(structures) > 1 else ()))
        self._uv = self._add_uv() if any(structures) else None
        self._textures = []  # for each look: use -> node
        shaders = [self._add_look(structure) for structure in structures]
        self._link(self._choice(shaders, 0), self._add("ShaderNodeOutputMaterial").inputs["Surface"])

    def set_constants(self, spec):
        for name, sockets in self._constants.items():
            value = spec[name]
            if self._present.get(name) == value:  # setting a socket updates the whole tree
                continue
            self._present[name] = value
            for socket in sockets:
                if socket.type == "RGBA":
                    socket.default_value = (*value, 1.0)
                else:
                    socket.default_value = value

    def set_images(self, looks, images, paths):
        for look, nodes in zip(looks, self._textures):
            for use, sha256 in look:
                image = images.get(sha256, "color" if use == "color" else "data", paths)
                if nodes[use].image != image:  # so does setting an image
                    nodes[use].image = image

    def _add(self, kind):
        return self._nodes.new(kind)

    def _link(self, output, socket):
        self._links.new(output, socket)

    def _add_attributes(self, slot, varying):
        """A property has four numbers, of which a colour takes three."""
        scalars = [(name, None) for name in varying if name != "base_color"]
        while scalars or (not self.properties and "base_color" in varying):
            attribute = self._add("ShaderNodeAttribute")
            attribute.attribute_type = "OBJECT"
            attribute.attribute_name = f"material{slot}.{len(self.properties)}"
            if not self.properties and "base_color" in varying:
                numbers = [("base_color", axis) for axis in range(3)]
                self._varying["base_color"] = attribute.outputs["Vector"]
            else:
                numbers, scalars = scalars[:3], scalars[3:]
                parts = self._add("ShaderNodeSeparateXYZ")
                self._link(attribute.outputs["Vector"], parts.inputs[0])
                for (name, _), output in zip(numbers, parts.outputs):
                    self._varying[name] = output
                numbers += numbers[-1:] * (3 - len(numbers))
            if scalars:
                self._varying[scalars[0][0]] = attribute.outputs["Alpha"]
            numbers.append(scalars.pop(0) if scalars else numbers[-1])
            self.properties[attribute.attribute_name] = numbers

    def _give(self, name, socket):
        """The value of that name to a socket."""
        if name in self._varying:
            self._link(self._varying[name], socket)
        else:
            self._constants[name].append(socket)

    def _add_uv(self):
        """UV coordinates times the repeats."""
        product = self._add("ShaderNodeVectorMath")
        product.operation = "SCALE"
        self._link(self._add("ShaderNodeTexCoord").outputs["UV"], product.inputs[0])
        self._give("texture_repeat", product.inputs["Scale"])
        return product.outputs["Vector"]

    def _choice(self, shaders, first):
        """The shader whose number the object names: halved until one is left. Cycles skips the half
        that has no weight."""
        if len(shaders) == 1:
            return shaders[0]
        half = len(shaders) // 2
        upper = self._add("ShaderNodeMath")
        upper.operation = "GREATER_THAN"
        upper.inputs[1].default_value = first + half - 0.5
        self._link(self._varying["look"], upper.inputs[0])
        mix = self._add("ShaderNodeMixShader")
        self._link(upper.outputs["Value"], mix.inputs[0])
        self._link(self._choice(shaders[:half], first), mix.inputs[1])
        self._link(self._choice(shaders[half:], first + half), mix.inputs[2])
        return mix.outputs[0]

    def _add_look(self, structure):
        principled = self._add("ShaderNodeBsdfPrincipled")
        principled.distribution = "GGX"  # the default is another one since Blender 4.0
        textures = {use: self._add_texture() for use in structure}
        self._textures.append(textures)
        for name in _SCALARS:
            socket = principled_input(principled, _SCALARS[name])
            if name in textures:
                self._link(textures[name].outputs["Color"], socket)
            else:
                self._give(name, socket)
        if "color" in textures:
            # A vector product is a colour product, by one node in every version of Blender.
            product = self._add("ShaderNodeVectorMath")
            product.operation = "MULTIPLY"
            self._link(textures["color"].outputs["Color"], product.inputs[0])
            self._give("base_color", product.inputs[1])
            self._link(product.outputs["Vector"], principled.inputs["Base Color"])
        else:
            self._give("base_color", principled.inputs["Base Color"])
        if "normal" in textures:
            normal_map = self._add("ShaderNodeNormalMap")
            normal_map.uv_map = "UVMap"
            self._link(textures["normal"].outputs["Color"], normal_map.inputs["Color"])
            self._link(normal_map.outputs["Normal"], principled.inputs["Normal"])
        if "alpha" in textures:
            self._link(textures["alpha"].outputs["Color"], principled.inputs["Alpha"])
        return principled.outputs["BSDF"]

    def _add_texture(self):
        texture = self._add("ShaderNodeTexImage")
        texture.interpolation = "Linear"
        texture.extension = "REPEAT"
        self._link(self._uv, texture.inputs["Vector"])
        return texture
