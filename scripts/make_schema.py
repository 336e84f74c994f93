#!/usr/bin/env python3
"""Makes configs/schema.json, a JSON Schema (draft 7) of campaign configs, from the key tables of docs/config.md.

    scripts/make_schema.py            writes configs/schema.json
    scripts/make_schema.py --stdout   prints it

A row of a key table is `| key | value | default | meaning |`. The value says which form is wanted, in the words
of the table under "Values" there; an unknown word is an error. What a table cannot say is written down here.
"""

import json
import pathlib
import re
import sys

HOME = pathlib.Path(__file__).resolve().parent.parent
PAGE = HOME / "docs" / "config.md"
SCHEMA = HOME / "configs" / "schema.json"

IDENTIFIER = "^[A-Za-z_][A-Za-z0-9_]*$"
LIGHT_TYPES = ("point", "sun", "spot", "area")


def ref(name):
    return {"$ref": f"#/definitions/{name}"}


def mapping(properties, required=()):
    schema = {"type": "object", "additionalProperties": False, "properties": properties}
    return {**schema, "required": sorted(required)} if required else schema


def one_key(name, schema):
    return mapping({name: schema}, [name])


def numbers(least, most=None):
    return {"type": "array", "items": ref("number"), "minItems": least, "maxItems": most or least}


def names_to(schema, pattern=IDENTIFIER):
    return {"type": ["object", "null"], "additionalProperties": False, "patternProperties": {pattern: schema}}


# --- the forms of docs/config/values.md ---

PARAMETERS = {
    "uniform": ("min", "max"),
    "normal": ("mean", "std"),
    "truncated_normal": ("mean", "std", "min", "max"),
    "bounded_normal": ("mean", "std", "min", "max"),
    "log_uniform": ("min", "max"),
    "integer": ("min", "max"),
    "poisson": ("mean",),
}


def distribution(name):
    parameters = PARAMETERS[name]
    forms = [numbers(len(parameters)), mapping({p: ref("number") for p in parameters}, parameters)]
    if len(parameters) == 1:
        forms.append(ref("number"))
    return one_key(name, {"anyOf": forms})


def choice(option):
    weighted = mapping({"value": option, "weight": ref("number")}, ["value"])
    return {"type": "array", "items": {"anyOf": [option, weighted]}, "minItems": 1}


def weights(keys):
    """{option: weight}"""
    return {"type": "object", "propertyNames": keys, "additionalProperties": ref("number"), "minProperties": 1}


def pair(first, first_schema, second, second_schema):
    listed = {"type": "array", "items": [first_schema, second_schema], "minItems": 2, "maxItems": 2}
    return {"anyOf": [listed, mapping({first: first_schema, second: second_schema}, [first, second])]}


def forms():
    number = ref("number")
    plain = r"^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$"
    of = {"anyOf": [ref("distribution")]}
    return {
        "formula": {"type": "string", "minLength": 1, "maxLength": 2000,
                    "description": "A formula, such as 0.5 * spread + 10cm"},
        "number": {"description": "A number, a formula or a distribution",
                   "anyOf": [{"type": "number"}, ref("formula"), ref("distribution")]},
        "distribution": {
            "description": "A mapping with one key, such as {uniform: [0, 1]}",
            "anyOf": [distribution(name) for name in PARAMETERS] + [
                one_key("constant", number),
                one_key("choice", {"anyOf": [choice(number), weights({"pattern": plain})]}),
                one_key("mixture", choice(number)),
                one_key("empirical", pair("file", ref("text"), "column", ref("text"))),
                one_key("sobol", pair("dimension", {"type": "integer", "minimum": 0, "maximum": 999}, "of", of)),
            ]},
        "vector": {"description": "[x, y, z], or a formula whose value is a vector",
                   "anyOf": [numbers(3), ref("formula")]},
        "colour": {
            "description": "[r, g, b] (linear), {rgb: …}, {hsv: [hue in degrees, saturation, value]}, {kelvin: t} "
                           "or a formula",
            "anyOf": [numbers(3), ref("formula"), one_key("rgb", numbers(3)), one_key("hsv", numbers(3)),
                      one_key("kelvin", number)]},
        "name": {"description": "A name, in which ${variable} stands for the value of a variable, or {choice: …}",
                 "anyOf": [ref("text"), one_key("choice", {"anyOf": [choice(ref("text")), weights(True)]})]},
        "material": {
            "description": "The name of a material, {choice: …}, or {realistic_share: …}",
            "anyOf": [ref("name"), mapping({"realistic_share": number, "realistic": ref("texts"),
                                            "parametric": ref("texts")}, ["realistic_share"])]},
        "value": {"description": "A number, a vector, a colour or a choice of names",
                  "anyOf": [number, ref("vector"), ref("colour"), ref("name")]},
        "values": names_to(ref("value")),
        "axes": names_to({"type": "array", "minItems": 1, "items": {"anyOf": [
            ref("text"), {"type": "object", "propertyNames": {"pattern": IDENTIFIER},
                          "additionalProperties": ref("text"), "minProperties": 1}]}}),
        "constant": {"description": "A plain number",
                     "anyOf": [{"type": "number"}, {"type": "string", "pattern": plain}]},
        # What YAML reads as a number or a flag may be a text.
        "text": {"type": ["string", "number", "boolean"], "minLength": 1},
        "texts": {"type": "array", "items": ref("text")},
        "level": {"description": "How often it is drawn anew", "enum": ["campaign", "scene", "frame"]},
    }


FORMS = {
    "number": ref("number"),
    "vector": ref("vector"),
    "colour": ref("colour"),
    "name": ref("name"),
    "material": ref("material"),
    "constant": ref("constant"),
    "integer": {"type": "integer"},
    "text": ref("text"),
    "texts": ref("texts"),
    "flag": {"type": "boolean"},
    "level": ref("level"),
    "two numbers": numbers(2),
    "one to three numbers": numbers(1, 3),
    "four numbers": numbers(4),
    "number or two numbers": {"anyOf": [ref("number"), numbers(2)]},
    "number or vector": {"anyOf": [ref("number"), numbers(3)]},
    "vector, or `objects`": ref("vector"),
    "integer, or one of `none`, `lzw`, `zip`": {"anyOf": [{"type": "integer", "minimum": 0, "maximum": 9},
                                                          {"enum": ["none", "lzw", "zip"]}]},
    "names and values": ref("values"),
    "names and lists": ref("axes"),
    "names and materials": names_to(ref("material"), "."),
    "name, or names and texts": {"anyOf": [ref("name"), names_to(ref("text"), ".")]},
    "paths and values": {"type": "object"},
}


def form_of(words):
    """The schema for a cell of the column "value"; None for a section, whose keys have rows of their own."""
    if words.startswith("section, or `") or words in ("section", "named sections", "section, or its source", "section, or its mode", "section, or its around"):
        return None
    if words in FORMS:
        return dict(FORMS[words])
    listed = re.findall(r"`([^`]+)`", words)
    if words.startswith("one of "):
        return {"enum": listed + ([False] if "off" in listed else [])}  # YAML 1.1 reads off as false
    if words.startswith("some of "):
        return {"type": "array", "items": {"enum": listed}}
    if words.startswith("as "):
        return ref(listed[0])
    raise SystemExit(f"make_schema.py: docs/config.md: unknown form of value '{words}'")


# --- the tables ---

def plain_text(markdown):
    text = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", markdown)
    return text.replace("\\|", "|").strip()


def bounds(meaning):
    found = re.search(r"(?<!\S)(\d[\d,]*) … (\d[\d,]*)(?![\d,^])", meaning)
    if not found:
        return {}
    least, most = (int(text.replace(",", "")) for text in found.groups())
    return {"minimum": least, "maximum": most}


def default_of(words):
    words = words.strip("`")
    try:
        value = json.loads(words)
    except ValueError:
        return {"default": words} if re.fullmatch(r"[A-Za-z]+", words) else {}
    return {"default": value}


class Key:
    def __init__(self, path, value, default, meaning):
        self.path = path
        self.value = value
        self.required = default == "required"
        self.meaning = plain_text(meaning)
        self.default = {} if default in ("", "none", "required") else default_of(default)

    def schema(self, form):
        schema = {} if form is None else form
        if self.value == "integer":
            schema.update(bounds(self.meaning))
        notes = {"description": self.meaning} if self.meaning and self.meaning != "below" else {}
        notes.update(self.default)
        # Draft 7 ignores what stands beside a $ref.
        return {**notes, "allOf": [schema]} if notes and "$ref" in schema else {**schema, **notes}


def read_keys(page):
    keys = []
    inside = False
    for line in page.splitlines():
        if line.startswith("|"):
            inside = inside or line == "| key | value | default | meaning |"
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if inside and cells[0].startswith("`"):
                keys.append(Key(cells[0].strip("`"), *cells[1:]))
        else:
            inside = False
    return keys


def add_light_types(schema, keys):
    """A key that is for some types of light only."""
    rules = []
    for key in keys:
        found = re.match(r"([a-z, ]+?) only\b", key.meaning)
        if not found or not key.path.startswith("lights.NAME."):
            continue
        types = [t for t in LIGHT_TYPES if re.search(rf"\b{t}\b", found.group(1))]
        name = key.path.rsplit(".", 1)[1]
        wanted = {"properties": {"type": {"enum": types}}}
        if "point" not in types:
            wanted["required"] = ["type"]
        rules.append({"if": {"required": [name]}, "then": wanted})
    schema["allOf"] = rules
    schema["oneOf"] = [{"required": [name]} for name in ("power", "lumens", "lux")]


def forbid(schema, *pairs):
    for names in pairs:
        schema.setdefault("allOf", []).append({"not": {"required": list(names)}})


def build(keys):
    by_path = {key.path: key for key in keys}

    def section(path):
        depth = path.count(".") + 1 if path else 0
        children = [k for k in keys if k.path.startswith(path + "." if path else "") and k.path.count(".") == depth]
        properties = {k.path.rsplit(".", 1)[-1]: entry(k) for k in children}
        schema = mapping(properties, [k.path.rsplit(".", 1)[-1] for k in children if k.required])
        schema["type"] = ["object", "null"] if not schema.get("required") else "object"
        return schema

    def entry(key):
        form = form_of(key.value)
        if key.value.startswith("section"):
            form = section(key.path)
        if key.value.startswith("section, or `"):
            form = {"anyOf": [form, {"enum": re.findall(r"`([^`]+)`", key.value)}]}
        if ", or its " in key.value:
            form = {"anyOf": [form, form["properties"][key.value.rsplit(" ", 1)[-1]]]}
        elif key.value == "named sections":
            form = ref(key.path)
        return key.schema(form)

    definitions = forms()
    for key in keys:
        if key.value == "named sections":
            free = key.path == "materials"  # their names need not be identifiers
            definitions[key.path] = names_to(section(key.path + ".NAME"), "." if free else IDENTIFIER)
    root = section("")
    root["type"] = "object"

    def named(name):
        return next(iter(definitions[name]["patternProperties"].values()))

    # What the tables say in words only.
    named("objects")["anyOf"] = [{"required": ["asset"]}, {"required": ["objects"]}]
    forbid(named("objects"), ("count", "grid"), ("scatter", "grid"), ("rotation", "rotation_deg"),
           ("rest", "rest_on_ground"), ("rest", "rotation"))
    add_light_types(named("lights"), by_path.values())
    forbid(named("lights"), ("count", "grid"))
    camera = root["properties"]["camera"]
    camera["oneOf"] = [{"required": ["position"]}, {"required": ["distance_m"]}]
    camera["dependencies"] = {"parent": ["target"]}
    forbid(camera, ("fov_deg", "focal_px"))
    root["properties"]["seedframe"] = {"const": 1, "description": by_path["seedframe"].meaning}
    required = root.pop("required")
    root["if"] = {"required": ["base"]}
    root["then"] = {"propertyNames": {"enum": ["seedframe", "base", "name", "description", "set"]}}
    root["else"] = {"required": required, "not": {"required": ["set"]}}
    forbid(root, ("graphs", "scenes"), ("graphs", "sweep"))
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Seedframe campaign config",
        "description": "Made by scripts/make_schema.py from docs/config.md",
        **root,
        "definitions": definitions,
    }


def schema_text():
    schema = build(read_keys(PAGE.read_text(encoding="utf-8")))
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"


def main():
    if sys.argv[1:] == ["--stdout"]:
        sys.stdout.write(schema_text())
    elif sys.argv[1:]:
        raise SystemExit(__doc__)
    else:
        SCHEMA.write_text(schema_text(), encoding="utf-8")


if __name__ == "__main__":
    main()
