// What a config says of objects, lights, cameras: what is refused, and where.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string section_error(const std::string& text) {
  const auto config = read_campaign_config(text, "scene.yaml");
  return message_of(config);
}

struct SectionCase {
  const char* text;
  const char* expected;
};

void expect_errors(const std::string& start, const std::vector<SectionCase>& cases,
                   const std::string& end) {
  for (const SectionCase& c : cases) {
    EXPECT_THAT(section_error(start + c.text + end), HasSubstr(c.expected)) << c.text;
  }
}

TEST(ObjectSection, MistakesAreNamedWithTheirPlace) {
  expect_errors(
      "seedframe: 1\ncamera: {distance_m: 1}\nobjects: {o: {asset: cube, ",
      {
          {"grid: 3", "scene.yaml:3:34: objects.o.grid: expected a mapping, found '3'"},
          {"grid: {}", "objects.o.grid: the key 'counts' is missing"},
          {"grid: {counts: 3}", "objects.o.grid.counts: expected [along x, along y, along z]"},
          {"grid: {counts: []}", "objects.o.grid.counts: expected [along x, along y, along z]"},
          {"grid: {counts: [1, 1, 1, 1]}", "found a list of 4"},
          {"grid: {counts: [1, {}]}",
           "scene.yaml:3:47: objects.o.grid.counts[1]: expected a number"},
          {"grid: {counts: [2], spacing_m: 3}", "objects.o.grid.spacing_m: expected a vector"},
          {"grid: {counts: [2], spacing: 3}",
           "objects.o.grid.spacing: unknown key (did you mean "
           "'spacing_m'?)"},
          {"grid: {counts: [2]}, count: 2", "objects.o.count: count and grid exclude each other"},
          {"grid: {counts: [2]}, scatter: {x: [0, 1], y: [0, 1]}", "scatter and grid exclude"},
          {"slots: body", "objects.o.slots: expected a mapping of material slots, found 'body'"},
          {"slots: {body: []}", "objects.o.slots.body: expected a name or {choice: …}"},
          {"slots: {body: {realistic_share: 1, x: 2}}", "objects.o.slots.body.x: unknown key"},
          {"scale: [1, 2]", "objects.o.scale: expected a list of three numbers"},
          {"scale: []", "objects.o.scale: expected a list of three numbers"},
          {"hidden_from: camera", "objects.o.hidden_from: expected a list of texts"},
          {"hidden_from: [cam]", "unknown kind of ray 'cam'"},
          {"position: 3", "objects.o.position: expected a vector, found '3'"},
          {"position: [1, 2, {}]", "objects.o.position[2]: expected a number, a formula or one"},
          {"redraw: always", "objects.o.redraw: expected scene, frame or campaign"},
          {"scatter: {x: [0, 1]}", "objects.o.scatter: the key 'y' is missing"},
          {"scatter: {x: [0], y: [0, 1]}", "objects.o.scatter.x: expected [least, most]"},
          {"objects: {p: {}}", "objects.o.objects.p: the key 'asset' is missing"},
          {"objects: [p]", "objects.o.objects: expected a mapping of names"},
          {"objects: {p q: {asset: cube}}", "objects.o.objects.p q: a name must be"},
          {"rest_on_ground: maybe", "objects.o.rest_on_ground: expected true or false"},
          {"variables: {a: {choice: []}}", "objects.o.variables.a.choice: choice needs a list"},
          {"variables: 3", "objects.o.variables: expected a mapping of variables"},
          {"variables: {a b: 1}", "objects.o.variables.a b: a variable's name"},
      },
      "}}\n");
}

TEST(GroupSection, NeedsNoAsset) {
  EXPECT_EQ(section_error("seedframe: 1\ncamera: {distance_m: 1}\nobjects: {g: {objects: {}}}\n"),
            "(no error)");
  EXPECT_THAT(section_error("seedframe: 1\ncamera: {distance_m: 1}\nobjects: {g: {scale: 2}}\n"),
              HasSubstr("scene.yaml:3:14: objects.g: the key 'asset' is missing"));
}

TEST(LightSection, MistakesAreNamedWithTheirPlace) {
  expect_errors("seedframe: 1\ncamera: {distance_m: 1}\nlights: {l: {",
                {
                    {"", "scene.yaml:3:13: lights.l: the key 'power' or 'lumens' is missing"},
                    {"type: sun", "lights.l: the key 'power' or 'lux' is missing"},
                    {"power: 1, lumens: 1", "lights.l: power and lumens exclude each other"},
                    {"type: sun, power: 1, lux: 1", "lights.l: power and lux exclude each other"},
                    {"power: 1, lux: 1", "lights.l.lux: unknown key"},
                    {"power: 1, width_m: 1", "lights.l.width_m: unknown key"},
                    {"power: 1, type: lamp", "lights.l.type: unknown type of light"},
                    {"power: 1, type: []", "lights.l.type: expected a text, found a list of 0"},
                    {"power: 1, grid: {counts: [1]}, count: 1", "count and grid exclude"},
                    {"power: 1, color: 3", "lights.l.color: expected a vector, found '3'"},
                },
                "}}\n");
}

TEST(WorldSection, MistakesAreNamedWithTheirPlace) {
  expect_errors("seedframe: 1\ncamera: {distance_m: 1}\nworld: ",
                {
                    {"3", "scene.yaml:3:8: world: expected a mapping, found '3'"},
                    {"{hdri: []}", "scene.yaml:3:15: world.hdri: expected a name or {choice: …}"},
                    {"{hdri: {uniform: [0, 1]}}", "world.hdri: expected a name or {choice: …}"},
                    {"{rotation: 3}", "unknown key (did you mean 'rotation_deg'?)"},
                },
                "\n");
}

TEST(MaterialSection, MistakesAreNamedWithTheirPlace) {
  expect_errors("seedframe: 1\ncamera: {distance_m: 1}\nmaterials: ",
                {
                    {"3", "scene.yaml:3:12: materials: expected a mapping, found '3'"},
                    {"[a]", "scene.yaml:3:12: materials: expected a mapping, found a list of 1"},
                    {"{m: 3}", "scene.yaml:3:16: materials.m: expected a mapping, found '3'"},
                    {"{m: {roughnes: 3}}", "unknown key (did you mean 'roughness'?)"},
                    {"{m: {base_color: {}}}", "materials.m.base_color: expected a colour"},
                    {"{m: {base_color: {hsv: tint}}}",
                     "materials.m.base_color.hsv: expected [hue, saturation, value], found 'tint'"},
                    {"{m: {base_color: {hsv: [1, 2]}}}",
                     "materials.m.base_color.hsv: expected [hue, saturation, value], found a list"},
                },
                "\n");
}

TEST(MaterialSection, AColourMayBeAFormulaInTwoWays) {
  for (const char* color : {"tint", "{rgb: tint}"}) {
    const auto config = read_campaign_config(
        std::string("seedframe: 1\ncamera: {distance_m: 1}\nmaterials: {m: {base_color: ") + color +
            "}}\n",
        "scene.yaml");
    ASSERT_TRUE(config) << config.error().message;
    const ColorSource& source = config->materials.at(0).base_color;
    EXPECT_EQ(source.model, ColorModel::kFormula) << color;
    EXPECT_EQ(std::get<Formula>(source.components[0].value).text, "tint") << color;
  }
}

TEST(Distributions, MistakesAreNamedWithTheirPlace) {
  expect_errors(
      "seedframe: 1\ncamera: {distance_m: 1}\nvariables: {scene: {a: ",
      {
          {"{empirical: 3}", "empirical needs [file, column], found '3'"},
          {"{empirical: [nowhere.csv, x]}",
           "scene.yaml:3:37: variables.scene.a.empirical[0]: there "
           "is no file nowhere.csv"},
          {"{empirical: [[], x]}", "expected a path, found a list of 0"},
          {"{empirical: {file: a, colunm: b}}", "unknown key (did you mean 'column'?)"},
          {"{sobol: [0]}", "sobol needs [dimension, of], found a list of 1"},
          {"{sobol: [0, 3]}", "sobol needs a distribution, such as {uniform: [0, 1]}"},
          {"{sobol: [-1, {uniform: [0, 1]}]}", "expected a whole number from 0 to 999, found '-1'"},
          {"{sobol: [1000, {uniform: [0, 1]}]}", "expected a whole number from 0 to 999"},
          {"{sobol: [0, {sobol: [1, {uniform: [0, 1]}]}]}", "sobol needs a distribution"},
          {"{mixture: 3}", "mixture needs a list of distributions"},
          {"{mixture: []}", "choice needs a list of options"},
          {"{mixture: {a: 1}}", "mixture needs a list of distributions"},
          {"{poisson: []}", "poisson needs [mean], found a list of 0"},
          {"{uniform: [1, 2], normal: [0, 1]}", "found a mapping of 2 keys"},
          {"{}", "found a mapping of 0 keys"},
          {"{choice: [{value: 1, wieght: 2}]}", "unknown key (did you mean 'weight'?)"},
          {"{choice: {1: x, y: 2}}", "this option is not a number"},
      },
      "}}\n");
}

TEST(WholeConfig, IsOneDocument) {
  EXPECT_THAT(section_error("seedframe: 1\ncamera: {distance_m: 1}\n---\nscenes: 5\n"),
              HasSubstr("scene.yaml:4:1: a config is one YAML document, and here a second begins"));
  EXPECT_EQ(section_error("---\nseedframe: 1\ncamera: {distance_m: 1}\n"), "(no error)");
  EXPECT_EQ(section_error("seedframe: 1\ncamera: {distance_m: 1}\n...\n"), "(no error)");
}

TEST(WholeConfig, ControlCharactersAreRefusedAndDoNotEndIt) {
  for (const char byte : {'\0', '\x01', '\x04', '\x1b', '\x7f'}) {
    const std::string text = "seedframe: 1\ncamera: {distance_m: 1}\n" + std::string(1, byte) +
                             "\nthis: is not a config\n";
    EXPECT_THAT(section_error(text), HasSubstr("scene.yaml:3:1: a control character (byte " +
                                               std::to_string(static_cast<int>(byte)) + ")"));
  }
  EXPECT_EQ(section_error("seedframe: 1\r\ncamera:\t{distance_m: 1}\r\n"), "(no error)");
}

TEST(WholeConfig, WhatIsNotUtf8IsRefused) {
  for (const char* bytes : {"\xff", "\x80", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                            "\xe2\x82", "\xf0\x8f\xbf\xbf"}) {
    EXPECT_THAT(section_error(std::string("seedframe: 1\ndescription: h\xc3\xa4 ") + bytes + "\n"),
                HasSubstr("scene.yaml:2:17: this is not UTF-8 (byte "))
        << bytes;
  }
  EXPECT_EQ(section_error(
                "\xEF\xBB\xBFseedframe: 1\ncamera: {distance_m: 1}\ndescription: \"\xe2\x82\xac "
                "\xf0\x9f\x98\x80\"\n"),
            "(no error)");
}

TEST(WholeConfig, DeepNestingIsRefused) {
  for (const int depth : {70, 400, 100'000}) {
    for (const char* open : {"[", "{a: ", "- ", "? "}) {
      std::string text = "seedframe: 1\ncamera: {distance_m: 1}\nx: ";
      for (int i = 0; i < depth; ++i) text += open;
      EXPECT_THAT(section_error(text + "\n"), HasSubstr("scene.yaml")) << open << depth;
    }
  }
}

}  // namespace
}  // namespace seedframe
