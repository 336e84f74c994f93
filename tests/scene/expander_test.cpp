#include "scene/expander.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "scene/material_library.h"
#include "scene/placement.h"
#include "spec/frame_spec_reader.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kBase = R"(seedframe: 1
seed: 5
scenes: 3
frames_per_scene: 2
categories: [gear]
render: {width: 64, height: 48, samples: 1}
variables:
  campaign: {tint: {uniform: [0, 360]}}
  scene: {parts: {integer: [1, 4]}}
  frame: {height: {uniform: [1, 2]}}
objects:
  gears:
    asset: gear
    count: parts
    variables: {spin: {uniform: [0, 360]}}
    position: [copy_index * 0.1, {normal: [0, 0.1]}, 0]
    rotation_deg: [0, 0, spin]
    material: paint
materials:
  paint: {base_color: {hsv: [tint, 0.5, 0.5]}, roughness: {uniform: [0.2, 0.8]}}
camera: {distance_m: height, azimuth_deg: {uniform: [0, 360]}}
lights: {key: {power: {uniform: [1, 2]}, position: [0, 0, 2]}}
)";

Result<SceneExpander> compile(const std::string& text) {
  const auto config = read_campaign_config(text, "scene.yaml");
  if (!config) return forward_error(config);
  const std::filesystem::path home = SEEDFRAME_HOME;
  auto assets = AssetLibrary::open({home / "assets"});
  if (!assets) return forward_error(assets);
  auto materials = MaterialLibrary::open({home / "materials"}, config->materials);
  if (!materials) return forward_error(materials);
  return SceneExpander::compile(*config, *assets, *materials);
}

std::string expansion_error(const std::string& text) {
  auto expander = compile(text);
  if (!expander) return expander.error().message;
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame);
    if (!expanded) return expanded.error().message;
  }
  return "(no error)";
}

std::map<std::string, Json> draws_of(const std::string& text, std::int64_t frame) {
  auto expander = compile(text);
  EXPECT_TRUE(expander) << expander.error().message;
  const auto expanded = expander->expand(frame, {.draws = true});
  EXPECT_TRUE(expanded) << expanded.error().message;
  std::map<std::string, Json> draws;
  for (const Draw& draw : expanded->draws) draws[draw.name] = draw.value;
  return draws;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Pinned: if this changes, every campaign ever rendered has other frames.
TEST(SceneExpander, FrameIdsAreWhatTheyHaveAlwaysBeen) {
  // No asset: its mesh may be modelled anew, and that makes other frames by right.
  auto expander = compile(R"(seedframe: 1
seed: 5
scenes: 3
frames_per_scene: 2
variables:
  campaign: {tint: {uniform: [0, 360]}}
  frame: {height: {truncated_normal: [1.5, 0.3, 1, 2]}}
materials:
  paint: {base_color: {hsv: [tint, 0.5, 0.5]}, roughness: {uniform: [0.2, 0.8]}}
ground: {width_m: 3, depth_m: {log_uniform: [1, 4]}, material: paint}
camera: {distance_m: height, azimuth_deg: {uniform: [0, 360]}, roll_deg: {normal: [0, 5]}}
lights:
  key: {power: {uniform: [1, 2]}, position: [0, 0, 2], color: {kelvin: {choice: [3000, 6000]}}}
  sun: {type: sun, power: 2, position: [1, 1, 2], count: {integer: [0, 3]}}
)");
  ASSERT_TRUE(expander) << expander.error().message;
  EXPECT_EQ(expander->expand(0)->id,
            "6be13fce7416db2e5f4b97eb61255e0830ffbf67dd59baa7db011c0f93b3917c");
  EXPECT_EQ(expander->expand(5)->id,
            "1eaf6d1b806f409c5d845bc3a5b809cf580d69ff6e6c06b59f38c020d09ad8dc");
}

TEST(SceneExpander, FirstDrawsAreWhatTheyHaveAlwaysBeen) {
  const auto draws = draws_of(kBase, 3);
  EXPECT_EQ(canonical_json(draws.at("variables.campaign.tint")), "185.22719763957767");
  EXPECT_EQ(canonical_json(draws.at("variables.scene.parts")), "2");
  EXPECT_EQ(canonical_json(draws.at("variables.frame.height")), "1.1274589156584325");
  EXPECT_EQ(canonical_json(draws.at("objects.gears.variables.spin/0")), "27.517576695883662");
}

TEST(SceneExpander, AFrameDoesNotDependOnWhichWereExpandedBefore) {
  auto forwards = compile(kBase);
  auto backwards = compile(kBase);
  std::vector<std::string> ids;
  for (std::int64_t frame = 0; frame < 6; ++frame) ids.push_back(forwards->expand(frame)->id);
  for (std::int64_t frame = 5; frame >= 0; --frame) {
    EXPECT_EQ(backwards->expand(frame)->id, ids[static_cast<std::size_t>(frame)]);
  }
}

TEST(SceneExpander, AddingAVariableLeavesAllOtherDrawsAsTheyWere) {
  const std::string more =
      replaced(replaced(replaced(kBase, "campaign: {tint", "campaign: {a0: {normal: [0, 1]}, tint"),
                        "scene: {parts", "scene: {a1: {uniform: [0, 1]}, parts"),
               "variables: {spin", "variables: {a2: {choice: [1, 2]}, spin");
  const std::string wider = replaced(
      more, "objects:\n",
      "objects:\n  first: {asset: cube, category: none, position: [{uniform: [5, 6]}, 0, 0]}\n");
  for (const std::int64_t frame : {0, 3, 5}) {
    const auto before = draws_of(kBase, frame);
    const auto after = draws_of(wider, frame);
    EXPECT_GT(after.size(), before.size());
    for (const auto& [name, value] : before) EXPECT_EQ(after.at(name), value) << name;
  }
}

TEST(SceneExpander, LevelsRedrawWhenTheyShould) {
  const auto frame0 = draws_of(kBase, 0);
  const auto frame1 = draws_of(kBase, 1);  // same scene
  const auto frame2 = draws_of(kBase, 2);  // next scene
  EXPECT_EQ(frame0.at("variables.campaign.tint"), frame2.at("variables.campaign.tint"));
  EXPECT_EQ(frame0.at("objects.gears.variables.spin/0"),
            frame1.at("objects.gears.variables.spin/0"));
  EXPECT_NE(frame0.at("objects.gears.variables.spin/0"),
            frame2.at("objects.gears.variables.spin/0"));
  EXPECT_NE(frame0.at("variables.frame.height"), frame1.at("variables.frame.height"));
  EXPECT_NE(frame0.at("camera.azimuth_deg"), frame1.at("camera.azimuth_deg"));
  EXPECT_EQ(frame0.at("lights.key.power/0"), frame1.at("lights.key.power/0"));
}

TEST(SceneExpander, CopiesDrawForThemselves) {
  const auto draws = draws_of(replaced(kBase, "count: parts", "count: 2"), 0);
  EXPECT_NE(draws.at("objects.gears.variables.spin/0"), draws.at("objects.gears.variables.spin/1"));
  EXPECT_NE(draws.at("objects.gears.material.paint.roughness/0"),
            draws.at("objects.gears.material.paint.roughness/1"));
}

TEST(SceneExpander, OtherSeedsGiveOtherFrames) {
  auto five = compile(kBase);
  auto six = compile(replaced(kBase, "seed: 5", "seed: 6"));
  EXPECT_NE(five->expand(0)->id, six->expand(0)->id);
}

TEST(SceneExpander, TheCameraStandsAtTheOriginAndLooksAtTheTarget) {
  auto expander = compile(
      "seedframe: 1\ncategories: [gear]\n"
      "objects: {o: {asset: gear, position: [1e6, -2e6, 3]}}\n"
      "camera: {target: [1e6, -2e6, 3], distance_m: 2, elevation_deg: 30, azimuth_deg: 77}\n");
  const auto frame = expander->expand(0);
  ASSERT_TRUE(frame);
  const Eigen::Vector3d seen = frame->spec.instances[0].camera_from_object.translation();
  // A thousand kilometres from the world's origin the object is still where it belongs to a
  // nanometre.
  EXPECT_NEAR(seen.x(), 0.0, 1e-9);
  EXPECT_NEAR(seen.y(), 0.0, 1e-9);
  EXPECT_NEAR(seen.z(), -2.0, 1e-9);
}

TEST(SceneExpander, ObjectsRestOnTheGroundWhateverTheirPose) {
  auto expander = compile(
      "seedframe: 1\nscenes: 20\ncategories: [hex_bolt]\n"
      "objects: {o: {asset: hex_bolt, rest_on_ground: true, scale: 2,\n"
      "  rotation_deg: [{uniform: [0, 360]}, {uniform: [0, 360]}, 0]}}\n"
      "camera: {position: [0, 0, 1], target: [0, 0, 0]}\n");
  const auto assets = AssetLibrary::open({std::filesystem::path(SEEDFRAME_HOME) / "assets"});
  const auto bolt = assets->load("hex_bolt");
  for (std::int64_t scene = 0; scene < 20; ++scene) {
    const auto frame = expander->expand(scene);
    const Affine& pose = frame->spec.instances[0].camera_from_object;
    double lowest = 1e9;  // the camera looks straight down from 1 m: world z is camera z + 1
    for (const auto& p : (*bolt)->mesh.positions) {
      lowest = std::min(lowest, (pose * Eigen::Vector3d(p[0], p[1], p[2])).z() + 1.0);
    }
    EXPECT_NEAR(lowest, 0.0, 1e-9);
  }
}

TEST(SceneExpander, ScatteredObjectsKeepApart) {
  auto expander = compile(
      "seedframe: 1\nscenes: 10\ncategories: [gear]\n"
      "objects: {o: {asset: gear, count: 12, scatter: {x: [-0.3, 0.3], y: [-0.3, 0.3], gap_m: "
      "0.01}}}\n"
      "camera: {position: [0, 0, 1], target: [0, 0, 0]}\n");
  for (std::int64_t scene = 0; scene < 10; ++scene) {
    const auto frame = expander->expand(scene);
    ASSERT_TRUE(frame) << frame.error().message;
    const auto& all = frame->spec.instances;
    ASSERT_EQ(all.size(), 12u);
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double distance =
            (all[i].camera_from_object.translation() - all[j].camera_from_object.translation())
                .norm();
        EXPECT_GT(distance, 0.065 + 0.01);  // the gear is 65 mm wide
      }
    }
  }
}

TEST(SceneExpander, AFrameIsOfTheNewVersionOnlyIfItNeedsIt) {
  FrameSpec spec = compile(kBase)->expand(4)->spec;
  EXPECT_EQ(to_json(spec)["version"], kOldestFrameSpecVersion);
  spec.render.levers.filter_glossy = 1.0;
  EXPECT_EQ(to_json(spec)["version"], 6);
  spec.render.region = PixelRect{0, 0, 8, 8};
  EXPECT_EQ(to_json(spec)["version"], 7);
  spec.render = {};
  spec.labels.target = 1;
  EXPECT_EQ(to_json(spec)["version"], 7);
  spec.sensor.emplace();
  EXPECT_EQ(to_json(spec)["version"], kFrameSpecVersion);
}

TEST(SceneExpander, FrameSpecsSurviveTheirJson) {
  auto expander = compile(kBase);
  const auto frame = expander->expand(4);
  const auto read =
      frame_spec_from_json(*parse_json(canonical_json(to_json(frame->spec)), "t"), "t");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(frame_id(*read), frame->id);
  Json newer = to_json(frame->spec);
  newer["version"] = kFrameSpecVersion + 1;
  EXPECT_THAT(
      frame_spec_from_json(newer, "frame.json").error().message,
      HasSubstr(fmt::format("frame.json is a frame spec of version {}", kFrameSpecVersion + 1)));
  FrameSpec all = frame->spec;
  all.world.hdri = "ab";
  all.world.importance_map_px = 77;
  all.render.adaptive = {0.05, 8};
  all.render.denoise = Denoise::kOidnFast;
  all.render.levers = {{1, 2, 3, 0}, 0.01, 8.0, 0.5, 512, true};
  all.render.region = PixelRect{3, 5, 20, 10};
  all.labels.target = 2;
  const auto all_read = frame_spec_from_json(to_json(all), "t");
  ASSERT_TRUE(all_read) << all_read.error().message;
  EXPECT_EQ(all_read->render.adaptive, all.render.adaptive);
  EXPECT_EQ(all_read->render.levers, all.render.levers);
  EXPECT_EQ(all_read->render.denoise, all.render.denoise);
  EXPECT_EQ(all_read->world.importance_map_px, 77);
  EXPECT_EQ(frame_id(*all_read), frame_id(all));
  Json damaged = to_json(frame->spec);
  damaged.erase("camera");
  EXPECT_FALSE(frame_spec_from_json(damaged, "frame.json"));
}

TEST(SceneExpander, TextureSetsAreMaterials) {
  auto expander = compile(
      "seedframe: 1\ncamera: {position: [0, 0, 1], target: [0, 0, 0]}\n"
      "ground: {material: " +
      std::string("Concrete01") + "}\n");
  ASSERT_TRUE(expander) << expander.error().message;
  const auto frame = expander->expand(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->spec.instances[0].id, 0);
  EXPECT_GE(frame->spec.materials[0].textures.size(), 3u);
  EXPECT_EQ(frame->used.images.size(), frame->spec.materials[0].textures.size());
}

TEST(SceneExpander, ImpossibleScenesAreErrorsThatNameTheKey) {
  struct Case {
    const char* from;
    const char* to;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"count: parts", "count: prats", "objects.gears.count: 'prats'"},
      {"count: parts", "count: copy_index", "objects.gears.count"},
      {"count: parts", "count: -1", "a count must be from 0"},
      {"count: parts", "count: {normal: [0, -1]}", "normal needs std >= 0"},
      {"count: parts", "count: 1/0", "a number must be finite"},
      {"asset: gear", "asset: gaer", "did you mean 'gear'?"},
      {"asset: gear", "asset: \"${which}\"", "no variable of names 'which'"},
      {"material: paint", "material: piant",
       "there is no material 'piant' (did you mean 'paint'?)"},
      {"material: paint", "scale: 0", "scale must be above 0"},
      {"material: paint", "scale: -2", "scale must be above 0"},
      {"material: paint", "category: gaer", "not among the campaign's categories"},
      {"categories: [gear]", "categories: []", "the category 'gear' of asset 'gear'"},
      {"roughness: {uniform: [0.2, 0.8]}", "roughness: 1.5", "roughness must be from 0 to 1"},
      {"roughness: {uniform: [0.2, 0.8]}", "roughness: {uniform: [0.8, 0.2]}",
       "uniform needs min <= max"},
      {"roughness: {uniform: [0.2, 0.8]}", "roughness: {integer: [0.5, 1]}", "whole numbers"},
      {"roughness: {uniform: [0.2, 0.8]}", "roughness: {log_uniform: [0, 1]}", "0 < min <= max"},
      {"roughness: {uniform: [0.2, 0.8]}", "roughness: {choice: {0.1: 0}}", "all weights are 0"},
      {"distance_m: height", "distance_m: height - 5", "distance_m must be above 0"},
      {"distance_m: height", "distance_m: height, fov_deg: 180", "fov_deg must be from"},
      {"distance_m: height", "distance_m: height, fov_deg: 175", "the view is too wide"},
      {"distance_m: height", "distance_m: height, clip_end_m: 0.001", "clip_end_m must be above"},
      {"tint: {uniform: [0, 360]}", "tint: b + 1, b: c, c: tint * 2",
       "refer to each other in a circle: tint → b → c → tint"},
      {"tint: {uniform: [0, 360]}", "tint: parts", "'parts' is neither a number"},
      {"{spin: {uniform: [0, 360]}}", "{spin: 1, parts: 2}", "the name 'parts' is taken"},
      {"power: {uniform: [1, 2]}", "power: -3", "power must be at least 0"},
      {"position: [copy_index * 0.1, {normal: [0, 0.1]}, 0]", "count_: 1", "unknown key"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(expansion_error(replaced(kBase, c.from, c.to)), HasSubstr(c.expected)) << c.to;
  }
}

TEST(SceneExpander, AScatterThatCannotBeSatisfiedEnds) {
  EXPECT_THAT(
      expansion_error("seedframe: 1\ncategories: [gear]\n"
                      "objects: {o: {asset: gear, count: 9, scatter: {x: [0, 0.1], y: [0, 0.1]}}}\n"
                      "camera: {distance_m: 1}\n"),
      HasSubstr("objects.o.scatter: no free place was found in 1000 attempts"));
}

TEST(Placement, MultiplesOfARightAngleAreExact) {
  const Eigen::Matrix3d turned = rotation_and_scale({90, 0, -180}, {1, 1, 1});
  for (int i = 0; i < 9; ++i) {
    const double entry = turned(i / 3, i % 3);
    EXPECT_TRUE(entry == 0.0 || entry == 1.0 || entry == -1.0) << entry;
  }
}

TEST(Placement, LookingStraightDownIsDefined) {
  const Affine view = looking_at({0, 0, 5}, {0, 0, 0}, 0.0);
  EXPECT_TRUE(view.matrix().allFinite());
  EXPECT_NEAR(view.linear().determinant(), 1.0, 1e-12);
  EXPECT_NEAR(view.linear()(1, 1), 1.0, 1e-12);  // y of the image points away
}

TEST(Placement, ShellAnglesAreAsDocumented) {
  const Eigen::Vector3d front = on_shell({0, 0, 0}, 2.0, 0.0, 0.0);
  EXPECT_NEAR(front.y(), -2.0, 1e-12);
  const Eigen::Vector3d right = on_shell({0, 0, 0}, 2.0, 90.0, 0.0);
  EXPECT_NEAR(right.x(), 2.0, 1e-12);
  const Eigen::Vector3d above = on_shell({0, 0, 0}, 2.0, 12.0, 90.0);
  EXPECT_NEAR(above.z(), 2.0, 1e-12);
}

TEST(SceneExpander, WithAutoDetailFarObjectsGetCoarserMeshes) {
  const auto mesh_bytes = [](const std::string& detail, double distance_m) {
    auto expander = compile(fmt::format(R"(seedframe: 1
categories: [gear]
objects: {{gears: {{asset: gear{}}}}}
camera: {{target: [0, 0, 0], distance_m: {}}}
)",
                                        detail, distance_m));
    const auto frame = expander->expand(0);
    EXPECT_TRUE(frame) << frame.error().message;
    return frame->meshes.at(frame->spec.instances[0].mesh)->size();
  };
  const std::size_t whole = mesh_bytes("", 0.2);
  EXPECT_EQ(mesh_bytes(", detail: auto", 0.2), whole) << "near, nothing is left out";
  EXPECT_EQ(mesh_bytes("", 20), whole);
  EXPECT_EQ(mesh_bytes(", detail: full", 20), whole);
  const std::size_t farther = mesh_bytes(", detail: auto", 2);
  EXPECT_LT(farther, 0.8 * static_cast<double>(whole));
  EXPECT_LT(mesh_bytes(", detail: auto", 20), farther);
}

}  // namespace
}  // namespace seedframe
