#include "mesh_files/color_slots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "mesh_files/gltf_reader.h"
#include "mesh_files/obj_reader.h"
#include "mesh_files/ply_reader.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ColorSlots : public ::testing::Test {
 protected:
  FileMesh read(const std::string& name, const std::string& text) const {
    EXPECT_TRUE(write_file(folder_ / name, text));
    const std::filesystem::path file = folder_ / name;
    auto mesh = name.ends_with(".ply")   ? read_ply(file)
                : name.ends_with(".obj") ? read_obj(file)
                                         : read_gltf(file);
    EXPECT_TRUE(mesh) << mesh.error().message;
    return mesh ? std::move(*mesh) : FileMesh();
  }
  const ScratchFolder folder_;
};

TEST(ColorCode, TakesValuesFromZeroToOne) {
  EXPECT_EQ(code_of_srgb({1.0, 0.5, 0.0}), 0xff8000U);
  EXPECT_EQ(code_of_srgb({2.0, -1.0, 0.0}), 0xff0000U);
  EXPECT_EQ(code_of_srgb({std::nan(""), 0.0, 0.0}), kNoColor);
  EXPECT_EQ(code_of_linear({1.0, 0.2158605, 0.0}), 0xff8000U);
}

TEST(ColorCode, OfATriangleIsThatOfTwoOfItsCorners) {
  EXPECT_EQ(color_of_triangle({1, 2, 2}), 2U);
  EXPECT_EQ(color_of_triangle({1, 2, 1}), 1U);
  EXPECT_EQ(color_of_triangle({1, 2, 3}), 1U);
}

constexpr const char* kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n";

TEST_F(ColorSlots, ColoursOfVerticesBecomeSlotsWithMaterials) {
  const FileMesh mesh =
      read("a.ply", std::string(kPlyHead) +
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                        "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n0 0 1 0 0 128\n"
                        "3 0 1 2\n3 3 3 0\n");
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("default", "ff0000", "000080"));
  EXPECT_THAT(mesh.mesh.triangle_slots, ElementsAre(1, 2));
  EXPECT_THAT(mesh.materials.at("ff0000").base_color, ElementsAre(1.0, 0.0, 0.0));
  EXPECT_THAT(mesh.materials.at("000080").base_color,
              ElementsAre(0.0, 0.0, DoubleNear(0.2158605, 1e-6)));
  EXPECT_THAT(mesh.not_kept, IsEmpty());
}

TEST_F(ColorSlots, ColoursOfFacesWin) {
  const FileMesh mesh =
      read("a.ply", std::string(kPlyHead) +
                        "element face 1\nproperty list uchar int vertex_indices\n"
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2 0 255 0\n");
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("default", "00ff00"));
}

TEST_F(ColorSlots, TheyMultiplyTheMaterialOfTheirSlotAndWhiteChangesNothing) {
  EXPECT_TRUE(write_file(folder_ / "m.mtl", "newmtl steel\nKd 0.5 0.5 0.5\nPr 0.2\n"));
  const FileMesh mesh = read(
      "a.obj",
      "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 1 1 1 1\nv 1 0 1 1 1 1\n"
      "usemtl steel\nf 1 2 3\nf 3 4 5\n");
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("steel", "steel_ff0000"));
  EXPECT_THAT(mesh.mesh.triangle_slots, ElementsAre(1, 0));
  const FileMaterial& red = mesh.materials.at("steel_ff0000");
  EXPECT_EQ(red.base_color[0], mesh.materials.at("steel").base_color[0]);
  EXPECT_EQ(red.base_color[1], 0.0);
  EXPECT_EQ(red.roughness, mesh.materials.at("steel").roughness);
}

TEST_F(ColorSlots, TooManyAreAPictureAndAreListed) {
  std::string text;
  for (int i = 0; i < 3 * 65; ++i) {
    text += fmt::format("v {} {} 0 0 {} 0\n", i % 3, i % 2, static_cast<double>(i / 3) / 255.0);
  }
  for (int i = 0; i < 65; ++i) {
    text += fmt::format("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
  }
  const FileMesh mesh = read("a.obj", text);
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("default"));
  EXPECT_THAT(mesh.not_kept, ElementsAre(HasSubstr("more than 64 different ones")));
}

TEST_F(ColorSlots, AColourThatIsNoNumberIsNone) {
  const FileMesh mesh =
      read("a.obj", "v 0 0 0 nan 0 0\nv 1 0 0 red 0 0\nv 0 1 0 nan 0 0\nf 1 2 3\n");
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("default"));
}

TEST_F(ColorSlots, GltfColoursAreLinear) {
  const FileMesh mesh = read("a.gltf", R"({"asset": {"version": "2.0"},
"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
               "min": [0, 0, 0], "max": [1, 1, 0]},
              {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 3,
               "type": "VEC4"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
"buffers": [{"byteLength": 48, "uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAP8A/wD/AP8A/wD/"}]})");
  EXPECT_THAT(mesh.mesh.slot_names, ElementsAre("default", "00ff00"));
}

}  // namespace
}  // namespace seedframe
