#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "mesh_files/mesh_file.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ObjReader : public ::testing::Test {
 protected:
  Result<Mesh> read(const std::string& text) {
    EXPECT_TRUE(write_file_unsynced(folder_ / "part.obj", text));
    auto file = read_mesh_file(folder_ / "part.obj");
    if (!file) return forward_error(file);
    dropped_ = file->dropped;
    return std::move(file->mesh);
  }

  void expect_error(const std::string& text, const std::string& place, const std::string& reason) {
    const auto mesh = read(text);
    ASSERT_FALSE(mesh) << text;
    EXPECT_EQ(mesh.error().kind, ErrorKind::kInput);
    EXPECT_THAT(mesh.error().message, HasSubstr(place));
    EXPECT_THAT(mesh.error().message, HasSubstr(reason));
  }

  ScratchFolder folder_;
  std::vector<std::string> dropped_;  // by the last read
};

TEST_F(ObjReader, ReadsPositionsUvsAndSlotsByName) {
  const auto mesh = read(
      "# a part\n"
      "mtllib part.mtl\n"
      "o part\n"
      "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0.5\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
      "usemtl steel\n"
      "f 1/1/1 2/2/1 3/3/1\n"
      "usemtl red paint\n"
      "f 1/1 3/3 4/4 # the other half\n"
      "usemtl steel\n"
      "f 1//1 2//1 4//1\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions.size(), 4u);
  EXPECT_THAT(mesh->slot_names, ElementsAre("steel", "red paint"));
  EXPECT_THAT(mesh->triangle_slots, ElementsAre(0u, 1u, 0u));
  EXPECT_EQ(mesh->positions[2][2], 0.5f);
  EXPECT_EQ(mesh->corner_uvs[2][1], 1.0f);
  EXPECT_EQ(mesh->corner_uvs[8][0], 0.0f);
  EXPECT_EQ(mesh->corner_uvs[8][1], 0.0f);
}

TEST_F(ObjReader, TriangulatesPolygonsAndCountsBackwards) {
  const auto mesh =
      read("v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nf -6 -5 -4 -3 -2 -1\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 4u);
  EXPECT_DOUBLE_EQ(surface_area(*mesh), 6.0);
  EXPECT_THAT(mesh->slot_names, ElementsAre("default"));
}

TEST_F(ObjReader, TakesCarriageReturnsContinuedLinesColoursAndNoLastNewline) {
  const auto mesh = read("v 0 0 0 1 0 0\r\nv +1.5e0 0 0\r\n\tv 0 1 0\r\n\r\nf 1 \\\r\n 2 3");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions[1][0], 1.5f);
  EXPECT_EQ(mesh->triangles.size(), 1u);
}

TEST_F(ObjReader, NamesTheLineOfWhatIsWrong) {
  expect_error("v 0 0 0\nv 1 abc 0\n", "part.obj:2", "'abc'");
  expect_error("v 0 0 0\nv 1 0\n", "part.obj:2", "at least 3 numbers, found 2");
  expect_error("v 0 0 nan\n", "part.obj:1", "finite");
  expect_error("v 0 0 1e60\n", "part.obj:1", "finite");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "part.obj:4", "no vertex 4: 3 stand above");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "part.obj:4", "'0'");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "part.obj:4", "no vertex -4");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3x\n", "part.obj:4", "'3x'");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/x 2 3\n", "part.obj:4", "'x'");
  expect_error("v 0 0 0\nv 1 0 0\n\\\nf 1 2\n", "part.obj:3", "3 corners or more, found 2");
}

TEST_F(ObjReader, KeepsTheFirstVertexBehindAByteOrderMark) {
  // The second mark: of a file that was put behind another one.
  const auto mesh =
      read("\xEF\xBB\xBFv 9 9 9\nv 1 0 0\n\xEF\xBB\xBFv 0 1 0\nv 0 1 1\nf 1 2 3\nf 1 3 4\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions.size(), 4u);
  EXPECT_EQ(mesh->positions[0][0], 9.0f);
  EXPECT_EQ(mesh->positions[2][1], 1.0f);
}

TEST_F(ObjReader, TellsOfLinesThatItDoesNotKnow) {
  ASSERT_TRUE(read("V 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\n# a\no a\ns 1\nf 1 2 3\nface 1 2 3\n"));
  EXPECT_THAT(dropped_, ElementsAre("lines that begin with an unknown word are skipped: 2 of them, "
                                    "the first at line 1"));
}

TEST_F(ObjReader, TakesUvsThatDoNotStandAboveTheirNumbersForNone) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* rest :
       {"f 1/1 2/2/7 3/3\n", "f 1/1 2/-2 3/3\nvt 1 1\n", "vt 1 1\nf 1/2 2/-2 3/7\n"}) {
    const auto mesh = read(vertices + rest);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(mesh->corner_uvs, ElementsAre(std::array{0.0f, 0.0f}, std::array{0.0f, 0.0f},
                                              std::array{0.0f, 0.0f}));
    EXPECT_THAT(dropped_, ElementsAre(HasSubstr("3 of them, the first at line"))) << rest;
  }
  ASSERT_TRUE(read(vertices + "vt 1 1\nf 1/1 2/1 3\n"));
  EXPECT_TRUE(dropped_.empty()) << "a corner may have no UV";
}

TEST_F(ObjReader, LooksAtNoNumbersThatItDoesNotUse) {
  const auto mesh = read(
      "v 0 0 0 nan nan inf\nv 1 0 0 1e60 0 0\nv 0 1 0 red -1.#IND\nvt 0 1 nan\nf 1/1 2/1 3/1\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->corner_uvs[0][1], 1.0f);
  EXPECT_TRUE(dropped_.empty());
}

TEST_F(ObjReader, MaterialNamesAreUtf8WhateverTheFileIs) {
  const auto mesh =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Geh\xE4use\nf 1 2 3\nusemtl Gehäuse\nf 1 2 3\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_THAT(mesh->slot_names, ElementsAre("Gehäuse"));
}

TEST_F(ObjReader, RefusesFilesWithoutASurface) {
  expect_error("", "part.obj", "no polygons");
  expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n", "part.obj", "no polygons");
  expect_error("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "part.obj", "zero area");
  EXPECT_FALSE(read_mesh_file(folder_ / "missing.obj"));
  EXPECT_FALSE(read_mesh_file(folder_.path()));
}

}  // namespace
}  // namespace seedframe
