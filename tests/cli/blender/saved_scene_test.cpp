// The scene of a frame as a .blend file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

constexpr const char* kScene = R"(seedframe: 1
name: scene
scenes: 1
categories: [gear]
render: {width: 40, height: 30, samples: 2}
objects: {gears: {asset: gear, count: 3, position: [{uniform: [-0.1, 0.1]}, 0, 0], material: steel}}
ground: {width_m: 2, depth_m: 2, material: Concrete01}
lights: {key: {type: area, position: [0.3, -0.4, 0.8], power: 8}}
camera: {target: [0, 0, 0], distance_m: 0.5, elevation_deg: 40}
)";

class RealBlenderSavedScene : public ProgramTest {};

TEST_F(RealBlenderSavedScene, HoldsObjectsImagesAndSettingsAndLeavesThePictureAsItIs) {
  write("scene.yaml", kScene);
  ASSERT_EQ(run({"submit", "scene.yaml", "-o", "c", "--blender", test_blender()}).exit_code, 0);
  const Outcome saved = run({"render", "c", "--frame", "0", "-o", "x.png", "--save-blend",
                             "x.blend", "--blender", test_blender()});
  ASSERT_EQ(saved.exit_code, 0) << saved.errors;
  EXPECT_EQ(*read_file(folder_ / "x.png"), *read_file(folder_ / "c/frames/000/000000/image.png"));
  const std::string magic = read_file(folder_ / "x.blend")->substr(0, 4);
  EXPECT_TRUE(magic == "\x28\xb5\x2f\xfd" || magic == "BLEN") << "no Zstandard, no plain .blend";

  write("look.py", R"(import sys
import bpy
bpy.ops.wm.open_mainfile(filepath=sys.argv[-1])
meshes = [each for each in bpy.context.scene.objects if each.type == "MESH"]
assert len(meshes) == 4, meshes
images = [each for each in bpy.data.images if each.source == "FILE"]
assert images and all(each.packed_file for each in images), images
assert bpy.context.scene.cycles.samples == 2
print("all is there")
)");
  run_in_blender(folder_ / "look.py", folder_ / "x.blend", folder_ / "log");
  EXPECT_THAT(*read_file(folder_ / "log"), ::testing::HasSubstr("all is there"));
}

}  // namespace
}  // namespace seedframe
