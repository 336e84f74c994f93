// One expander, several threads: every frame as if it were the only one.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

constexpr int kThreads = 4;

/// Variables of all levels and kinds, nested copies, textures, a ground that changes by the scene,
/// and constraints of every kind, some of which are often not met.
constexpr const char* kBusyScene = R"(seedframe: 1
seed: 6
scenes: 6
frames_per_scene: 3
categories: [gear, hex_nut]
max_attempts: 1000
variables:
  campaign: {size: {uniform: [1, 2]}}
  scene:
    spread: {uniform: [0.2, 0.4]}
    tint: {hsv: [{uniform: [0, 360]}, 0.5, 1]}
  frame:
    part: {choice: [gear, hex_nut]}
    gap: {uniform: [0.05, 0.12]}
    shift: [{uniform: [-0.05, 0.05]}, 0, 0]
sweep:
  values: {lamp: [{watts: 20, place: left}, {watts: 60, place: right}]}
objects:
  pair:
    count: {integer: [1, 3]}
    scatter: {x: [-0.3, spread], y: [-0.3, 0.3]}
    objects:
      piece:
        asset: ${part}
        category: ${part}
        count: 2
        variables: {turn: {uniform: [0, 360]}}
        position: "[copy_index * gap, 0, 0.05] + shift"
        rotation_deg: [0, 0, turn + copies]
        material: {choice: [aluminium, Concrete01]}
  washer: {asset: washer, category: none, detail: auto, position: [0, 0.5, 0.2], material: default}
lights:
  key:
    position: ["place == 'left' ? -1 : 1", -1, 2]
    color: tint
    power: watts * size
ground: {width_m: "2 + spread", depth_m: 3, curvature_per_m: 0.01, material: Concrete01}
camera:
  target: [0, 0, 0]
  distance_m: {uniform: [0.8, 1.2]}
  azimuth_deg: {uniform: [0, 360]}
  elevation_deg: {uniform: [20, 60]}
constraints:
  seen: {type: visible, objects: [piece], at_least: 0.3}
  large: {type: pixels, objects: [piece], at_least: 12}
  apart: {type: apart, objects: [piece], at_least: 0.03}
render: {width: 96, height: 64}
)";

/// All that a frame came with, as text.
std::string everything_of(const ExpandedFrame& frame) {
  std::string text = canonical_text(frame.spec) + frame.id + frame.graph.dump();
  for (const Draw& draw : frame.draws) text += draw.name + draw.value.dump() + " ";
  for (const auto& [sha256, buffer] : frame.meshes) text += sha256 + *buffer;
  for (const auto& [name, asset] : frame.used.assets) text += name + asset->mesh_sha256;
  for (const auto& [sha256, file] : frame.used.images) text += file->sha256 + file->path.string();
  for (const ConstraintTally& tally : frame.constraints) {
    text += fmt::format(" {}/{}", tally.met, tally.checked);
  }
  return text + fmt::format(" {} {} {}", frame.scene, frame.view, frame.attempts);
}

std::vector<std::string> expanded_in_order(const SceneExpander& expander) {
  std::vector<std::string> frames;
  for (std::int64_t i = 0; i < expander.frame_count(); ++i) {
    frames.push_back(everything_of(frame_of(expander, i)));
  }
  return frames;
}

/// Each thread expands all frames, in an order of its own; those that are not as expected.
std::int64_t differences(const SceneExpander& expander, const std::vector<std::string>& expected) {
  std::atomic<std::int64_t> different = 0;
  std::vector<std::thread> threads;
  for (unsigned thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&, thread] {
      std::vector<std::size_t> order(expected.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::shuffle(order.begin(), order.end(), std::mt19937(thread));
      for (const std::size_t i : order) {
        const auto frame =
            expander.expand(static_cast<std::int64_t>(i), {.draws = true, .graph = true});
        if (!frame || everything_of(*frame) != expected[i]) ++different;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return different;
}

TEST(ExpanderThreads, FramesAreThoseOfOneThread) {
  const auto one = expander_of(kBusyScene);
  ASSERT_TRUE(one) << one.error().message;
  const std::vector<std::string> expected = expanded_in_order(*one);
  ASSERT_EQ(expected.size(), 36u);
  const auto shared = expander_of(kBusyScene);  // nothing is kept yet
  ASSERT_TRUE(shared);
  EXPECT_EQ(differences(*shared, expected), 0);
}

TEST(ExpanderThreads, GraphsGiveEachSceneItsOwnValues) {
  const ScratchFolder folder;
  std::ofstream(folder / "graphs.jsonl")
      << "{\"reach\": 1}\n{\"reach\": 2}\n{\"side\": 3}\n{}\n{\"reach\": 5, \"side\": 1}\n";
  const std::string text = R"(seedframe: 1
graphs: graphs.jsonl
frames_per_scene: 4
variables:
  scene: {reach: {uniform: [3, 4]}, side: 2}
camera: {target: [0, 0, 0], position: [reach, side, {uniform: [1, 2]}]}
)";
  const auto one = expander_of(text, folder / "scene.yaml");
  ASSERT_TRUE(one) << one.error().message;
  const std::vector<std::string> expected = expanded_in_order(*one);
  const auto shared = expander_of(text, folder / "scene.yaml");
  ASSERT_TRUE(shared);
  EXPECT_EQ(differences(*shared, expected), 0);
}

}  // namespace
}  // namespace seedframe
