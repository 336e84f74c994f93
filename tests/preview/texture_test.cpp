#include "preview/texture.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "image/exr_file.h"
#include "image/png_file.h"
#include "preview/linear_image.h"
#include "preview/shading_images.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using Eigen::Vector3f;

/// Columns from left to right, rows from the top, each pixel of one grey.
Image<float> greys(int width, int height, const std::vector<float>& values) {
  Image<float> image(width, height, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = values[i / 3];
  return image;
}

TEST(Texture, UGoesRightAndVGoesUp) {
  const Texture texture(greys(2, 2, {0.1F, 0.2F, 0.3F, 0.4F}));
  EXPECT_NEAR(texture.color(0.25, 0.75, 0).x(), 0.1, 0.003);
  EXPECT_NEAR(texture.color(0.75, 0.75, 0).x(), 0.2, 0.003);
  EXPECT_NEAR(texture.color(0.25, 0.25, 0).x(), 0.3, 0.003);
  EXPECT_NEAR(texture.color(0.75, 0.25, 0).x(), 0.4, 0.003);
  EXPECT_NEAR(texture.color(0.5, 0.75, 0).x(), 0.15, 0.003) << "half way between two";
}

TEST(Texture, Repeats) {
  const Texture texture(greys(3, 2, {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F}));
  for (const double u : {0.1, 0.3, 0.77, 0.999}) {
    const Vector3f here = texture.color(u, 0.4, 0);
    EXPECT_TRUE(texture.color(u + 7, 0.4, 0).isApprox(here, 1e-5F)) << u;
    EXPECT_TRUE(texture.color(u - 3, -1.6, 0).isApprox(here, 1e-5F)) << u;
  }
  EXPECT_NEAR(texture.color(0.0, 0.75, 0).x(), 0.2, 0.003) << "between its last and first column";
}

TEST(Texture, FromFarAwayIsItsMeanAndInBetweenAMeanOfNeighbours) {
  std::vector<float> stripes(64 * 64);
  for (std::size_t i = 0; i < stripes.size(); ++i) stripes[i] = i % 64 < 32 ? i % 2 : 0.25F;
  const Texture texture(greys(64, 64, stripes));
  EXPECT_NEAR(texture.mean().x(), 0.375, 1e-4);
  EXPECT_EQ(texture.color(0.3, 0.3, 5.0), texture.mean());
  // Stripes of a pixel each are light's mean from four pixels on, and no moiré.
  for (const double u : {0.2, 0.21, 0.24}) {
    EXPECT_NEAR(texture.color(u, 0.5, 4.0 / 64).x(), 0.5, 0.01);
    EXPECT_NEAR(texture.color(u + 0.5, 0.5, 4.0 / 64).x(), 0.25, 0.01);
  }
  EXPECT_GT(std::abs(texture.color(32.5 / 64, 0.5, 0).x() - texture.color(1.5 / 64, 0.5, 0).x()),
            0.5);
}

class ImageFiles : public ::testing::Test {
 protected:
  HashedFile file(const std::string& name) const { return {folder_ / name, name}; }
  HashedFile png(const std::string& name, const Image<std::uint8_t>& image) const {
    EXPECT_TRUE(write_file(folder_ / name, encode_png(image)));
    return file(name);
  }
  ScratchFolder folder_;
};

TEST_F(ImageFiles, OfIntegersAreSrgbAndOfFloatsLinear) {
  Image<std::uint8_t> codes(2, 1, 3);
  codes.values = {0, 128, 255, 10, 188, 64};
  const auto light = read_linear_image(png("codes.png", codes).path, 64);
  ASSERT_TRUE(light) << light.error().message;
  const std::vector<float> expected = {0.0F, 0.21586F, 1.0F, 0.0030353F, 0.50289F, 0.05127F};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(light->values[i], expected[i], 1e-4) << i;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(srgb_code(light->values[i]), codes.values[i]);

  Image<float> exr(2, 1, 3);
  exr.values = {0.5F, 2.0F, -1.0F, 0.0F, 0.25F, 1.0F};
  ASSERT_TRUE(write_exr(folder_ / "light.exr", exr, {"R", "G", "B"}));
  const auto as_it_is = read_linear_image(folder_ / "light.exr", 64);
  ASSERT_TRUE(as_it_is) << as_it_is.error().message;
  EXPECT_EQ(as_it_is->values, (std::vector<float>{0.5F, 2.0F, 0.0F, 0.0F, 0.25F, 1.0F}));
}

TEST_F(ImageFiles, OfGreyHaveThreeEqualChannels) {
  Image<std::uint8_t> grey(2, 1, 1);
  grey.values = {128, 255};
  const auto light = read_linear_image(png("grey.png", grey).path, 64);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->values[0], light->values[2]);
  EXPECT_NEAR(light->values[1], 0.21586, 1e-4);
  EXPECT_EQ(light->values[4], 1.0F);
}

TEST_F(ImageFiles, ThatAreLargeAreReducedInLight) {
  Image<std::uint8_t> stripes(50, 30, 3);
  for (std::size_t i = 0; i < stripes.values.size(); ++i) stripes.values[i] = i / 3 % 2 * 255;
  const auto light = read_linear_image(png("stripes.png", stripes).path, 25);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->width, 25);
  EXPECT_EQ(light->height, 15);
  for (const float value : light->values) EXPECT_NEAR(value, 0.5, 1e-4);
}

TEST_F(ImageFiles, AreReadOnce) {
  ShadingImages images;
  const HashedFile kept = png("kept.png", Image<std::uint8_t>(2, 2, 3));
  const auto first = images.texture(kept);
  ASSERT_TRUE(first);
  std::filesystem::remove(kept.path);
  const auto second = images.texture(kept);
  ASSERT_TRUE(second);
  EXPECT_EQ(*first, *second);
  const auto missing = images.texture(file("missing.png"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("missing.png"), std::string::npos);
  EXPECT_TRUE(images.texture(png("missing.png", Image<std::uint8_t>(1, 1, 3))))
      << "an error is not kept";
}

TEST_F(ImageFiles, ThatAreDamagedAreAnError) {
  ASSERT_TRUE(
      write_file(folder_ / "cut.png", encode_png(Image<std::uint8_t>(9, 9, 3)).substr(0, 60)));
  ShadingImages images;
  const auto cut = images.texture(file("cut.png"));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::kInput);
}

struct Weight {
  std::size_t bytes() const { return 40; }
};

TEST(ImageShelf, ForgetsWhatWasUsedLeastRecently) {
  ImageShelf<Weight> shelf(100);
  int made = 0;
  const auto get = [&](const std::string& name) {
    return *shelf.get(name, [&]() -> Result<Weight> {
      ++made;
      return Weight{};
    });
  };
  const auto held = get("a");
  get("b");
  get("a");
  EXPECT_EQ(made, 2);
  get("c");  // in place of b
  EXPECT_EQ(shelf.bytes(), 80U);
  get("a");
  EXPECT_EQ(made, 3);
  get("b");
  EXPECT_EQ(made, 4);
  EXPECT_EQ(shelf.bytes(), 80U);
  EXPECT_EQ(held->bytes(), 40U) << "who holds it keeps it";
}

}  // namespace
}  // namespace seedframe
