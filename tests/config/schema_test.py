#!/usr/bin/env python3
"""configs/schema.json is what scripts/make_schema.py makes, accepts every good config and refuses bad ones."""

import copy
import pathlib
import re
import sys
import unittest

import jsonschema
import yaml

sys.dont_write_bytecode = True
HOME = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(HOME / "scripts"))
import make_schema  # noqa: E402

PAGES = [HOME / "docs" / "config.md", HOME / "docs" / "config" / "values.md"]
GOOD = """
seedframe: 1
categories: [gear]
objects: {gears: {asset: gear, count: 3}}
lights: {lamp: {type: spot, power: 3}}
camera: {distance_m: 1}
"""


def as_json(value):
    """JSON has no keys but texts."""
    if isinstance(value, dict):
        return {str(key): as_json(item) for key, item in value.items()}
    return [as_json(item) for item in value] if isinstance(value, list) else value


def load(text):
    return as_json(yaml.safe_load(text))


def examples():
    """The yaml blocks of the pages as whole configs."""
    for page in PAGES:
        for text in re.findall(r"```yaml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
            config = load(text)
            if not text.startswith("seedframe:"):
                config = {"seedframe": 1, "camera": {"distance_m": 1}, **config}
            yield text, config


def with_value(path, value):
    """GOOD with the value at a path of keys replaced, added or (None) removed."""
    config = copy.deepcopy(load(GOOD))
    *parents, last = path.split(".")
    node = config
    for key in parents:
        node = node.setdefault(key, {})
    if value is None:
        del node[last]
    else:
        node[last] = load(value)
    return config


class SchemaTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = make_schema.build(make_schema.read_keys(PAGES[0].read_text(encoding="utf-8")))
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def accepts(self, config, what):
        error = jsonschema.exceptions.best_match(self.validator.iter_errors(config))
        self.assertIsNone(error, f"{what}\n{error and (list(error.absolute_path), error.message)}")

    def test_the_committed_schema_is_what_the_script_makes(self):
        committed = make_schema.SCHEMA.read_text(encoding="utf-8")
        self.assertEqual(committed, make_schema.schema_text(), "run scripts/make_schema.py")

    def test_is_a_schema(self):
        jsonschema.Draft7Validator.check_schema(self.schema)

    def test_has_the_distributions_of_the_page(self):
        page = PAGES[1].read_text(encoding="utf-8")
        section = page[page.index("## Distributions"):page.index("## Vectors")]
        rows = re.findall(r"^\| `(\w+)` \| `\{\1: ", section, re.MULTILINE)
        options = self.schema["definitions"]["distribution"]["anyOf"]
        self.assertCountEqual(rows, [option["required"][0] for option in options])

    def test_accepts_all_configs(self):
        configs = sorted((HOME / "configs").glob("*.yaml"))
        self.assertTrue(configs)
        for path in configs:
            with self.subTest(path.name):
                self.accepts(load(path.read_text(encoding="utf-8")), path.name)

    def test_accepts_the_examples_of_the_page(self):
        count = 0
        for text, config in examples():
            count += 1
            with self.subTest(text.splitlines()[0]):
                self.accepts(config, text)
        self.assertGreaterEqual(count, 17)

    def test_accepts_values_in_all_their_forms(self):
        self.accepts(load(GOOD), GOOD)
        for path, value in [
            ("camera.roll_deg", "{choice: {0: 3, 90: 1}}"),
            ("camera.roll_deg", "{choice: [{value: a + 1, weight: 2}, {uniform: [0, 1]}]}"),
            ("camera.roll_deg", "{mixture: [{normal: [0, 1]}, {value: {poisson: 3}, weight: w}]}"),
            ("camera.roll_deg", "{empirical: {file: a.csv, column: roll}}"),
            ("camera.roll_deg", "{sobol: [3, {normal: {mean: 0, std: 1}}]}"),
            ("camera.target", "objects"),
            ("camera.focal_px", "[600, 601]"),
            ("objects.gears.material", "{realistic_share: {uniform: [0, 1]}, parametric: [steel]}"),
            ("objects.gears.slots", "{body: '${kind}', Some other slot.001: brass}"),
            ("objects.gears.objects", "{a: {objects: {b: {asset: gear, objects: {}}}}}"),
            ("objects.gears.scale", "[1, 2, {uniform: [1, 2]}]"),
            ("materials", "{my-paint: {base_color: tint}}"),
            ("variables.scene", "{a: [1, b, 2cm], kind: {choice: [x, y]}, c: {hsv: [1, 1, 1]}, d: 3}"),
            ("sweep", "{values: {a: [1, 2], b: [{x: 1, y: text}]}, hold_draws: false}"),
            ("render.filter_width_px", "'1e0'"),
            ("image", "{format: jpeg, quality: 80}"),
            ("image.compression", "9"),
            ("image", "{format: tiff, compression: none}"),
            ("world", "null"),
        ]:
            with self.subTest(f"{path}: {value}"):
                self.accepts(with_value(path, value) if value != "null" else {**load(GOOD), "world": None}, value)

    def test_refuses_wrong_configs(self):
        for path, value in [
            ("camera", None),
            ("seedframe", "2"),
            ("rnder", "{}"),
            ("render.width", "0"),
            ("render.width", "{uniform: [1, 2]}"),
            ("render.passes", "[dept]"),
            ("image.gamma", "a + 1"),
            ("image.format", "jpg"),
            ("image.quality", "0"),
            ("image.quality", "101"),
            ("image.compression", "10"),
            ("image.compression", "deflate"),
            ("camera.position", "[0, 0, 1]"),  # and distance_m
            ("camera.distance_m", None),
            ("camera.fov_deg", "{uniform: [1, 2, 3]}"),
            ("camera.fov_deg", "{unform: [1, 2]}"),
            ("camera.fov_deg", "{uniform: [1, 2], normal: [1, 2]}"),
            ("camera.fov_deg", "[1, 2]"),
            ("camera.target", "[0, 0]"),
            ("camera.target", "3"),
            ("camera.roll_deg", "{sobol: [0, 3]}"),
            ("camera.parent", "gears"),  # without a target
            ("objects.gears.asset", None),
            ("objects.gears.grid", "{counts: [2]}"),  # and count
            ("objects.gears.objects", "{a: {asset: gear, colour: red}}"),
            ("objects.gears.hidden_from", "[diffus]"),
            ("objects.gears.rest_on_ground", "yes please"),
            ("objects.gears.redraw", "copy"),
            ("objects.2nd", "{asset: gear}"),
            ("lights.lamp.power", None),
            ("lights.lamp.lumens", "800"),  # and power
            ("lights.lamp.angle_deg", "[30]"),
            ("lights.lamp.width_m", "1"),  # of an area only
            ("lights.sun", "{type: sun, lumens: 3}"),
            ("lights.lamp.color", "{rgb: [1, 1, 1], kelvin: 3000}"),
            ("constraints.a", "{type: seen}"),
            ("constraints.a", "{at_least: 1}"),
            ("sweep", "{values: {a: 3}}"),
            ("max_attempts", "0"),
            ("set", "{seed: 3}"),  # without a base
        ]:
            with self.subTest(f"{path}: {value}"):
                self.assertFalse(self.validator.is_valid(with_value(path, value)))

    def test_knows_configs_on_a_base(self):
        self.accepts({"base": "a.yaml", "name": "b", "set": {"render.samples": 3}}, "base")
        self.assertFalse(self.validator.is_valid({**load(GOOD), "base": "a.yaml"}))


if __name__ == "__main__":
    unittest.main()
