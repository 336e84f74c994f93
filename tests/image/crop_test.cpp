#include "image/crop.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(Crop, TakesARectangle) {
  Image<std::uint8_t> image(4, 3, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(i);
  }
  const auto out = cropped(image, {1, 1, 2, 2});
  EXPECT_EQ(out.values,
            (std::vector<std::uint8_t>{15, 16, 17, 18, 19, 20, 27, 28, 29, 30, 31, 32}));
}

TEST(Crop, PutsAPartWhereItWas) {
  Image<std::uint16_t> part(2, 1, 2);
  part.values = {1, 2, 3, 4};
  const auto whole = placed_at(part, {1, 1, 2, 1}, 4, 3, std::uint16_t{9});
  EXPECT_EQ(whole.values, (std::vector<std::uint16_t>{9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 1, 2,
                                                      3, 4, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9}));
}

TEST(Crop, ClearsWhatIsOutside) {
  Image<std::uint16_t> image(3, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint16_t>(i + 1);
  }
  fill_outside(image, {1, 0, 2, 2}, std::uint16_t{0});
  EXPECT_EQ(image.values, (std::vector<std::uint16_t>{0, 2, 3, 0, 5, 6, 0, 0, 0}));
}

}  // namespace
}  // namespace seedframe
