// Workers that do not render what the frame spec says: the real Blender with scripts that have one
// fault each. Every one must be caught by the twin, and named.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kFaulty = R"(seedframe: 1
name: faulty
seed: 5
frames_per_scene: 2
categories: [gear, hex_bolt]
render: {width: 160, height: 120, samples: 1}
objects:
  gears: {asset: gear, position: [0, 0, 0]}
  bolts: {asset: hex_bolt, count: 2, scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}, redraw: frame}
camera: {target: [0, 0, 0], distance_m: 0.4, elevation_deg: 50, azimuth_deg: {uniform: [0, 360]}}
)";

struct Fault {
  const char* name;
  const char* script;
  const char* was;
  const char* is;
};

class RealBlenderFault : public ProgramTest {
 protected:
  /// A home whose worker scripts have one line changed.
  void plant(const Fault& fault) {
    const fs::path home = folder_ / "home";
    fs::create_directories(home);
    for (const char* name : {"assets", "materials"}) {
      fs::create_symlink(fs::path(SEEDFRAME_HOME) / name, home / name);
    }
    fs::copy(fs::path(SEEDFRAME_HOME) / "blender_scripts", home / "blender_scripts");
    std::string text = *read_file(home / "blender_scripts" / fault.script);
    const std::size_t at = text.find(fault.was);
    ASSERT_NE(at, std::string::npos) << fault.was;
    text.replace(at, std::string(fault.was).size(), fault.is);
    ASSERT_TRUE(write_file(home / "blender_scripts" / fault.script, text));
    write_config("faulty.yaml", kFaulty);
  }
  Outcome submit() {
    return run({"submit", "faulty.yaml", "-o", "c", "--workers", "1", "--max-attempts", "1"},
               {"SEEDFRAME_HOME=" + (folder_ / "home").string()});
  }
  void expect_caught(const Fault& fault, const char* named) {
    plant(fault);
    const Outcome outcome = submit();
    EXPECT_EQ(outcome.exit_code, 3) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("twin")) << fault.name;
    EXPECT_THAT(outcome.errors, HasSubstr(named)) << fault.name;
    EXPECT_TRUE(exists("c/rejected"));
  }
};

TEST_F(RealBlenderFault, WithoutAFaultEveryFrameIsLikeItsTwin) {
  plant({"none", "scene_builder.py", "import bpy", "import bpy"});
  const Outcome outcome = submit();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json told = status("c").at("twin");
  EXPECT_EQ(told.at("frames"), 2);
  EXPECT_EQ(told.at("inside_px"), 0);
  EXPECT_LE(told.at("edge_px"), 4);
  EXPECT_FALSE(exists("c/rejected"));
}

TEST_F(RealBlenderFault, AWrongTransformIsCaught) {
  // The gear alone, 2 mm to the side: about a pixel.
  expect_caught({"transform", "scene_builder.py", "item.matrix_parent_inverse = _matrix(",
                 "item.matrix_parent_inverse = Matrix.Translation((0.002 * (spec[\"id\"] == 1), 0, "
                 "0)) @ _matrix("},
                "'gears/0'");
}

TEST_F(RealBlenderFault, AWrongCameraIsCaught) {
  expect_caught(
      {"camera", "scene_builder.py", "put(camera, lens=lens_mm", "put(camera, lens=1.02 * lens_mm"},
      "instance '");
}

TEST_F(RealBlenderFault, AStaleMeshIsCaught) {
  // Whatever is asked for, the cache gives the first mesh that it ever read.
  expect_caught(
      {"mesh", "mesh_cache.py", "return self._cache.get(sha256, lambda: self._load(sha256, paths))",
       "self._first = getattr(self, '_first', sha256); return self._cache.get(self._first, "
       "lambda: self._load(self._first, paths))"},
      "instance 'bolts/");
}

TEST_F(RealBlenderFault, AMissingObjectIsCaught) {
  expect_caught(
      {"missing", "scene_builder.py", "item.pass_index = spec[\"id\"]",
       "item.pass_index = spec[\"id\"]; item.hide_render = spec[\"name\"] == \"bolts/1\""},
      "'bolts/1'");
}

TEST_F(RealBlenderFault, SwappedIdsAreCaught) {
  expect_caught({"ids", "scene_builder.py", "item.pass_index = spec[\"id\"]",
                 "item.pass_index = {2: 3, 3: 2}.get(spec[\"id\"], spec[\"id\"])"},
                "instance 'bolts/");
}

}  // namespace
}  // namespace seedframe
