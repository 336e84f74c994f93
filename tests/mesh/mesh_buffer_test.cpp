#include "mesh/mesh_buffer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "mesh/mesh_buffer_view.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

TEST(MeshBuffer, RoundTripsEveryBit) {
  const Mesh cube = example_cube();
  const auto read = mesh_from_buffer(mesh_buffer(cube), "buffer");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->positions, cube.positions);
  EXPECT_EQ(read->triangles, cube.triangles);
  EXPECT_EQ(read->corner_uvs, cube.corner_uvs);
  EXPECT_EQ(read->triangle_slots, cube.triangle_slots);
  EXPECT_EQ(read->slot_names.size(), 2u);
  EXPECT_EQ(read->smooth_angle_rad, 0.5);
}

TEST(MeshBuffer, HasTheBytesOfTheFormatPage) {
  const std::string bytes = mesh_buffer(example_cube());
  EXPECT_EQ(bytes.size(), 8u + 16u + 12u * 8u + (12u + 24u + 4u) * 12u);
  EXPECT_EQ(bytes.substr(0, 8), "SFMESH01");
  EXPECT_EQ(bytes.substr(8, 16), std::string("\x08\0\0\0\x0c\0\0\0\x02\0\0\0\0\0\0\x3f", 16));
  EXPECT_EQ(sha256_hex(bytes), "c1bda86533e5f957aa03076d968adb415c10ae26c3e98179eb8f7d33cf4beba4");
}

TEST(MeshBuffer, IsLookedIntoWithoutBeingRead) {
  const Mesh mesh = example_patch(3);
  const std::string bytes = "x" + mesh_buffer(mesh);  // wherever it lies
  const MeshBufferView view(std::string_view(bytes).substr(1));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_EQ(view.triangle(t), mesh.triangles[t]);
    EXPECT_EQ(view.slot(t), mesh.triangle_slots[t]);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(view.uvs(t)[corner], mesh.corner_uvs[3 * t + corner]);
    }
  }
  EXPECT_EQ(view.position(5), mesh.positions[5]);
  EXPECT_EQ(MeshBufferView(mesh_buffer(example_cube())).slot(11), 1U);
}

TEST(MeshBuffer, RefusesEveryOtherLength) {
  const std::string bytes = mesh_buffer(example_cube());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto read = mesh_from_buffer(std::string_view(bytes).substr(0, length), "cut.mesh");
    ASSERT_FALSE(read) << length;
    EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(read.error().message, HasSubstr("cut.mesh"));
  }
  EXPECT_FALSE(mesh_from_buffer(bytes + '\0', "long.mesh"));
}

TEST(MeshBuffer, RefusesNothing) {
  const std::string header = mesh_buffer(example_cube()).substr(0, 8);
  EXPECT_FALSE(mesh_from_buffer(header + std::string(16, '\0'), "empty.mesh"));
}

TEST(MeshBuffer, RefusesDamagedContents) {
  std::string bytes = mesh_buffer(example_cube());
  bytes[7] = '2';
  EXPECT_FALSE(mesh_from_buffer(bytes, "newer.mesh"));

  bytes = mesh_buffer(example_cube());
  bytes[24 + 12 * 8] = '\x09';  // the first triangle's first vertex
  const auto read = mesh_from_buffer(bytes, "damaged.mesh");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(read.error().message, HasSubstr("triangle 0 names vertex 9"));
}

}  // namespace
}  // namespace seedframe
