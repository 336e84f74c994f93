// Contrast and noise along the edges of ids.

#include "image/edge_error.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "image/luminance.h"
#include "tests/image/metric_pictures.h"

namespace seedframe {
namespace {

/// Grey pictures of one row.
Image<float> gray_row(const std::vector<float>& values) {
  Image<float> image(static_cast<int>(values.size()), 1, 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * i + c] = values[i];
  }
  return image;
}

Image<std::uint16_t> id_row(const std::vector<std::uint16_t>& ids) {
  Image<std::uint16_t> image(static_cast<int>(ids.size()), 1, 1);
  image.values = ids;
  return image;
}

TEST(EdgeError, LuminanceHasTheWeightsOfRec709) {
  EXPECT_DOUBLE_EQ(luminance(1.0, 0.0, 0.0), 0.2126);
  EXPECT_DOUBLE_EQ(luminance(0.0, 1.0, 0.0), 0.7152);
  EXPECT_DOUBLE_EQ(luminance(1.0, 1.0, 1.0), 1.0);
}

TEST(EdgeError, ASideIsTwoPixelsOfAnId) {
  const auto ids = id_row({1, 1, 1, 2, 2, 2});
  const auto reference = gray_row({9.0F, 1.0F, 2.0F, 6.0F, 8.0F, 50.0F});
  const auto rendering = gray_row({7.0F, 1.0F, 3.0F, 6.0F, 9.0F, 40.0F});
  const EdgeError error = edge_error(rendering, reference, ids);
  EXPECT_EQ(error.pairs, 1);
  EXPECT_NEAR(error.contrast, 5.5, 1e-12);  // 1.5 against 7
  EXPECT_NEAR(error.noise(), 0.0, 1e-12);   // 2 against 7.5
  EXPECT_NEAR(error.kept, 1.0, 1e-12);
}

TEST(EdgeError, ASideEndsWithItsIdAndWithThePicture) {
  // Edges: 10 | 20, 20 | 60, 60 | 90.
  const auto ids = id_row({1, 2, 3, 3, 4});
  const auto reference = gray_row({10.0F, 20.0F, 50.0F, 70.0F, 90.0F});
  const auto rendering = gray_row({10.0F, 21.0F, 50.0F, 70.0F, 87.0F});
  const EdgeError error = edge_error(rendering, reference, ids);
  EXPECT_EQ(error.pairs, 3);
  EXPECT_NEAR(error.contrast, (10.0 + 40.0 + 30.0) / 3.0, 1e-12);
  EXPECT_NEAR(error.mean_square, (1.0 + 1.0 + 9.0) / 3.0, 1e-12);
  EXPECT_NEAR(error.kept, (11.0 + 39.0 + 27.0) / 80.0, 1e-12);
  EXPECT_NEAR(error.signal_to_noise(), (80.0 / 3.0) / std::sqrt(11.0 / 3.0), 1e-12);
}

TEST(EdgeError, ColumnsCountAsRowsDo) {
  const auto picture = noisy_picture(20, 16, 30);
  const auto reference = reference_picture(20, 16);
  const auto turned = [](const auto& image) {
    auto result = image;
    std::swap(result.width, result.height);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        for (int c = 0; c < image.channels; ++c)
          result.at(column, row, c) = image.at(row, column, c);
      }
    }
    return result;
  };
  Image<std::uint16_t> ids(20, 16, 1);
  for (int row = 3; row < 9; ++row) {
    for (int column = 0; column < 7 + row % 2; ++column) ids.at(row, column) = 5;
  }
  const EdgeError error = edge_error(picture, reference, ids);
  const EdgeError of_turned = edge_error(turned(picture), turned(reference), turned(ids));
  EXPECT_EQ(error.pairs, 7 + 8 + 6 + 5);  // above, below, right, steps
  EXPECT_EQ(of_turned.pairs, error.pairs);
  EXPECT_NEAR(of_turned.contrast, error.contrast, 1e-9);
  EXPECT_NEAR(of_turned.mean_square, error.mean_square, 1e-9);
}

TEST(EdgeError, NoiseAwayFromEdgesIsNotSeen) {
  const auto reference = reference_picture(24, 24);
  auto picture = noisy_picture(24, 24, 50);
  Image<std::uint16_t> ids(24, 24, 1);
  for (int row = 0; row < 24; ++row) {
    for (int column = 12; column < 24; ++column) ids.at(row, column) = 1;
    for (int column = 10; column < 14; ++column) {
      for (int c = 0; c < 3; ++c) picture.at(row, column, c) = reference.at(row, column, c);
    }
  }
  const EdgeError error = edge_error(picture, reference, ids);
  EXPECT_EQ(error.pairs, 24);
  EXPECT_EQ(error.noise(), 0.0);
  EXPECT_TRUE(std::isinf(error.signal_to_noise()));
}

TEST(EdgeError, BlurLosesContrastAndBrightnessAloneNone) {
  const auto ids = id_row({1, 1, 1, 2, 2, 2});
  const auto reference = gray_row({0.0F, 0.0F, 0.0F, 8.0F, 8.0F, 8.0F});
  EXPECT_NEAR(edge_error(gray_row({0.0F, 1.0F, 3.0F, 5.0F, 7.0F, 8.0F}), reference, ids).kept, 0.5,
              1e-12);
  const auto brighter = gray_row({3.0F, 3.0F, 3.0F, 11.0F, 11.0F, 11.0F});
  EXPECT_NEAR(edge_error(brighter, reference, ids).kept, 1.0, 1e-12);
  EXPECT_NEAR(edge_error(brighter, reference, ids).noise(), 0.0, 1e-12);
}

TEST(EdgeError, OfOneIdOrNoPixelsHasNoPairs) {
  const auto none = edge_error(gray_row({1.0F, 2.0F}), gray_row({3.0F, 5.0F}), id_row({4, 4}));
  EXPECT_EQ(none.pairs, 0);
  EXPECT_EQ(none.contrast, 0.0);
  EXPECT_EQ(none.noise(), 0.0);
  EXPECT_EQ(none.kept, 1.0);
  EXPECT_EQ(edge_error(gray_row({}), gray_row({}), id_row({})).pairs, 0);
}

TEST(EdgeError, PairsWithNaNOrInfinityAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const auto ids = id_row({1, 2, 3, 4});
  const auto reference = gray_row({1.0F, 3.0F, 8.0F, 9.0F});
  const EdgeError error = edge_error(gray_row({nan, 3.0F, 7.0F, infinity}), reference, ids);
  EXPECT_EQ(error.pairs, 1);
  EXPECT_NEAR(error.contrast, 5.0, 1e-12);
  EXPECT_NEAR(error.noise(), 1.0, 1e-12);
}

}  // namespace
}  // namespace seedframe
