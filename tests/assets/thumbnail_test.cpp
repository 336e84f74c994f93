#include "assets/thumbnail.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

TEST(Thumbnail, ShowsTheMeshInTheMiddleOnWhite) {
  const Image<std::uint8_t> picture = thumbnail(example_cube(), 64);
  ASSERT_EQ(picture.width, 64);
  ASSERT_EQ(picture.channels, 3);
  for (const int corner : {0, 63}) EXPECT_EQ(picture.at(corner, corner, 1), 255);
  EXPECT_LT(picture.at(32, 32, 1), 250);
}

TEST(Thumbnail, EveryMeshFillsThePictureWhateverItsSize) {
  Mesh mesh = example_cube();
  const Image<std::uint8_t> of_metres = thumbnail(mesh, 32);
  for (auto& p : mesh.positions) {
    for (float& coordinate : p) coordinate = 0.001F * coordinate + 7.0F;
  }
  const Image<std::uint8_t> of_millimetres = thumbnail(mesh, 32);
  int different = 0;
  for (std::size_t i = 0; i < of_metres.values.size(); ++i) {
    different += std::abs(of_metres.values[i] - of_millimetres.values[i]) > 8 ? 1 : 0;
  }
  EXPECT_LT(different, 30);
}

TEST(Thumbnail, SlotsDifferInColour) {
  const Image<std::uint8_t> picture = thumbnail(example_cube(), 64);
  bool grey = false;
  bool tinted = false;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int difference = picture.at(y, x, 0) - picture.at(y, x, 2);
      if (picture.at(y, x, 0) < 250) (difference > 20 ? tinted : grey) = true;
    }
  }
  EXPECT_TRUE(grey);
  EXPECT_TRUE(tinted);
}

TEST(Thumbnail, ASlotWithoutTrianglesChangesNothing) {
  Mesh mesh = example_cube();
  const Image<std::uint8_t> without = thumbnail(mesh, 32);
  mesh.slot_names.emplace_back("unused");
  EXPECT_EQ(thumbnail(mesh, 32).values, without.values);
}

}  // namespace
}  // namespace seedframe
