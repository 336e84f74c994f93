// Configs as nobody meant them: cut, shuffled, with values from hell. The same ones on every
// machine.
#pragma once

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"

namespace seedframe {

class ConfigMutations {
 public:
  explicit ConfigMutations(std::uint32_t seed) : engine_(seed) {}

  /// One to three changes.
  std::string mutated(std::string text) {
    const std::size_t changes = 1 + below(3);
    for (std::size_t i = 0; i < changes && !text.empty(); ++i) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t bound) { return engine_() % bound; }

  const std::string& nasty() {
    static const std::vector<std::string> kTokens = {"NaN",
                                                     ".nan",
                                                     "inf",
                                                     "-.inf",
                                                     "-1",
                                                     "0",
                                                     "-0",
                                                     "1e999",
                                                     "-1e999",
                                                     "1e308",
                                                     "-1e308",
                                                     "1e-320",
                                                     "99999999999999999999",
                                                     "0x10",
                                                     "1_000",
                                                     "''",
                                                     "\"\"",
                                                     "[]",
                                                     "{}",
                                                     "[[]]",
                                                     "[{}]",
                                                     "~",
                                                     "null",
                                                     "true",
                                                     "${",
                                                     "\"${\"",
                                                     "\"${}\"",
                                                     "\"${x}\"",
                                                     "\"${kind}\"",
                                                     "*a",
                                                     "&a",
                                                     "&a 1",
                                                     "!!binary x",
                                                     "!!str 3",
                                                     "|",
                                                     ">",
                                                     "\t",
                                                     std::string(1, '\0'),
                                                     "\"\\0\"",
                                                     "\x04",
                                                     "\xff\xfe",
                                                     "日本",
                                                     "\"\xF0\x9F\x98\x80\"",
                                                     "1/0",
                                                     "0/0",
                                                     "sqrt(-1)",
                                                     "((((",
                                                     "30deg + 2m",
                                                     "3m",
                                                     "40W",
                                                     "[1, 2]",
                                                     "[1, 2, 3, 4]",
                                                     "[a, b, c]",
                                                     "[1e308, 1e308, 1e308]",
                                                     "{uniform: [1, 0]}",
                                                     "{uniform: [a, b]}",
                                                     "{uniform: [-1e308, 1e308]}",
                                                     "{choice: {}}",
                                                     "{choice: {a: 0}}",
                                                     "{choice: [cube, washer]}",
                                                     "{choice: {nan: 1, 2: x}}",
                                                     "{empirical: [/dev/zero, a]}",
                                                     "{empirical: [., a]}",
                                                     "{sobol: [0, {uniform: [0, 1]}]}",
                                                     "{integer: [1, 1e18]}",
                                                     "{poisson: 1e9}",
                                                     "{poisson: 3}",
                                                     "{mixture: [[]]}",
                                                     "{log_uniform: [1e-320, 1e308]}",
                                                     "{truncated_normal: [0, 1, 1e300, 1e308]}",
                                                     "{hsv: x}",
                                                     "{hsv: [0, 0, 1e300]}",
                                                     "{kelvin: -1}",
                                                     "{rgb: [1, 2]}",
                                                     "{realistic_share: 2}",
                                                     "{realistic_share: 0.5}",
                                                     "{value: 3}",
                                                     "a: b: c",
                                                     "- - -",
                                                     "? x",
                                                     "@",
                                                     "%",
                                                     "`",
                                                     "\"",
                                                     "'",
                                                     "#",
                                                     "<<: *a",
                                                     "objects",
                                                     "none",
                                                     "cube",
                                                     "copy_index",
                                                     "scene_index / 0",
                                                     "pi",
                                                     "../../etc/passwd",
                                                     "/dev/null",
                                                     std::string(3000, 'x'),
                                                     std::string(3000, '1'),
                                                     std::string(200, '['),
                                                     std::string(500, '-')};
    return kTokens[below(kTokens.size())];
  }

  static std::vector<std::size_t> line_starts(const std::string& text) {
    std::vector<std::size_t> starts = {0};
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
      if (text[i] == '\n') starts.push_back(i + 1);
    }
    return starts;
  }
  struct Line {
    std::size_t begin = 0, length = 0;  ///< with its end
  };
  Line line(const std::string& text) {
    const auto starts = line_starts(text);
    const std::size_t begin = starts[below(starts.size())];
    const std::size_t end = text.find('\n', begin);
    return {begin, (end == std::string::npos ? text.size() : end + 1) - begin};
  }

  /// From a random character on the next run of letters, digits and the like.
  void replace_word(std::string& text, const std::string& by) {
    const auto is_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '.' || c == '-';
    };
    std::size_t begin = below(text.size());
    while (begin < text.size() && !is_word(text[begin])) ++begin;
    while (begin > 0 && begin < text.size() && is_word(text[begin - 1])) --begin;
    std::size_t end = begin;
    while (end < text.size() && is_word(text[end])) ++end;
    text.replace(begin, end - begin, by);
  }

  void replace_value(std::string& text) {
    std::size_t colon = text.find(": ", below(text.size()));
    if (colon == std::string::npos) return replace_word(text, nasty());
    const std::size_t end = text.find_first_of("\n,}", colon + 2);
    text.replace(colon + 2, (end == std::string::npos ? text.size() : end) - colon - 2, nasty());
  }

  /// An alias bomb of 10^9 values, and one use of it.
  void plant_bomb(std::string& text) {
    std::string bomb = "b0: &b0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 9; ++i) {
      bomb += "b" + std::to_string(i) + ": &b" + std::to_string(i) + " [";
      for (int j = 0; j < 10; ++j) bomb += (j > 0 ? ", *b" : "*b") + std::to_string(i - 1);
      bomb += "]\n";
    }
    replace_word(text, "*b8");
    text = bomb + text;
  }

  void change(std::string& text) {
    const std::size_t at = below(text.size());
    const Line one = line(text);
    switch (below(16)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.insert(at, 1, static_cast<char>(below(128)));
        break;
      case 3:
        text.erase(at, 1 + below(20));
        break;
      case 4:
        text.erase(one.begin, one.length);
        break;
      case 5:
        text.insert(one.begin, text.substr(one.begin, one.length));
        break;
      case 6: {
        const std::string moved = text.substr(one.begin, one.length);
        text.erase(one.begin, one.length);
        if (!text.empty()) text.insert(line(text).begin, moved);
        break;
      }
      case 7:
        text.insert(one.begin, below(2) == 0 ? "  " : "\t");
        break;
      case 8:
        if (text[one.begin] == ' ') text.erase(one.begin, 1 + below(2));
        break;
      case 9:
        text.insert(one.begin, nasty() + "\n");
        break;
      case 10:
        text.insert(at, nasty());
        break;
      case 11:
        if (below(20) == 0) plant_bomb(text);
        break;
      case 12:
        replace_word(text, nasty());
        break;
      default:
        replace_value(text);
    }
  }

  std::mt19937 engine_;
};

/// Of a message that a user reads.
inline void expect_readable(const std::string& message, const std::string& what) {
  EXPECT_NE(message.find(".yaml"), std::string::npos) << message << "\n" << what;
  for (const char* word : {"std::", "exception", "yaml-cpp", "bad conversion", "basic_string",
                           "[json.", "out_of_range", "bad_alloc", "vector::", "bad file"}) {
    EXPECT_EQ(message.find(word), std::string::npos) << message << "\n" << what;
  }
}

struct NamedText {
  std::filesystem::path file;
  std::string text;
};

/// configs/*.yaml, sorted.
inline std::vector<NamedText> example_configs() {
  std::vector<NamedText> configs;
  const std::filesystem::path folder = std::filesystem::path(SEEDFRAME_HOME) / "configs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto text = read_file(entry.path());
    EXPECT_TRUE(text);
    configs.push_back({entry.path(), text.value_or("")});
  }
  std::sort(configs.begin(), configs.end(),
            [](const NamedText& a, const NamedText& b) { return a.file < b.file; });
  return configs;
}

/// One that uses everything that the language has, small enough to be expanded thousands of times.
inline constexpr const char* kEverything = R"yaml(seedframe: 1
name: everything
description: all that the language has
seed: 4
scenes: 2
frames_per_scene: 2
categories: [washer, gear]
render: {width: 32, height: 24, samples: 1, max_bounces: 2, clamp_indirect: 3, passes: [depth]}
image: {display: sRGB, view: Filmic, look: None, exposure_stops: 0.5, gamma: 1.1}
max_attempts: 5
sweep:
  hold_draws: true
  values:
    tint: [red, blue]
    size: [{w: 1, h: 2}, {w: 2, h: 1}]
variables:
  campaign:
    hue: {uniform: [0, 360]}
    corner: [1cm, 2cm, 0m]
  scene:
    reach: {truncated_normal: [20cm, 5cm, 10cm, 30cm]}
    kind: {choice: {cube: 2, washer: 1}}
    even: {sobol: [0, {normal: [0, 1]}]}
    shade: {hsv: [hue, 0.5, 0.6]}
    both: {mixture: [{value: {uniform: [0, 1]}, weight: 3}, {value: 2, weight: 1}]}
    many: {poisson: 2}
  frame:
    turn: {uniform: [0deg, 360deg]}
    tall: "kind == 'cube' ? max(0, corner.x) : length(corner)"
materials:
  red_paint: {base_color: shade, roughness: {uniform: [0.2, 0.8]}, metallic: 0.1, specular: 0.4}
  blue_paint: {base_color: {kelvin: 9000}, transmission: 0.5, ior: 1.3, clearcoat: 0.2}
  floor: {textures: Planks01, base_color: [0.7, 0.6, 0.5], texture_repeat: 2}
objects:
  stack:
    count: {integer: [1, 2]}
    variables: {lift: {log_uniform: [1cm, 2cm]}}
    position: [copy_index * 0.3, 0, lift]
    rotation_deg: [0, 0, turn]
    scale: {uniform: [0.9, 1.1]}
    objects:
      lid:
        asset: "${kind}"
        category: none
        grid: {counts: [2, 1], spacing_m: [6cm, 1, 1]}
        material: "${tint}_paint"
  loose:
    asset: washer
    count: many
    redraw: frame
    scatter: {x: [-reach, reach], y: [-reach, reach], gap_m: 1mm}
    rest_on_ground: true
    scale: [1, w, h]
    slots: {body: {realistic_share: 0.5, realistic: [floor], parametric: [red_paint, blue_paint]}}
    hidden_from: [shadow]
lights:
  lamps:
    type: spot
    grid: {counts: [2, 1, 1], spacing_m: [1, 1, 1]}
    position: [0, 0, 2]
    lumens: 800lm
    angle_deg: 60
    blend: 0.2
    color: {kelvin: 4000K}
  sun: {type: sun, lux: 10000, position: "rotate_z([1m, 0m, 1m], 30deg)", variables: {a: 1}}
  panel: {type: area, power: 20W, width_m: 0.2, height_m: 0.3, count: 1}
ground: {width_m: 2, depth_m: 3, curvature_per_m: 0.05, material: floor}
world: {hdri: studio, strength: 0.4, rotation_deg: {uniform: [0, 360]}, color: [1, 0.9, 0.8]}
constraints:
  seen: {type: visible, objects: [lid], at_least: 0}
  spread: {type: distance, objects: [loose], at_least: 1mm}
  free: {type: apart, objects: [lid], at_least: 0.1mm}
camera:
  variables: {near: {uniform: [0.5, 0.8]}}
  parent: stack
  position: [near, 0, 0.5]
  target: [0, 0, 0]
  focal_px: [30, 31]
  center_px: [15, 12]
  f_stop: 2.8
  sensor_width_mm: 8
  focus_distance_m: 60cm
  roll_deg: 3
  clip_start_m: 0.02
  clip_end_m: 50
)yaml";

}  // namespace seedframe
