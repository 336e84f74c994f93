#include "spec/scaled_view.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

FrameSpec view() {
  FrameSpec spec;
  spec.render.width = 640;
  spec.render.height = 480;
  spec.render.region = PixelRect{10, 10, 20, 20};
  spec.camera.focal_px = {800.0, 820.0};
  spec.camera.center_px = {319.5, 239.5};
  return spec;
}

/// Where a direction, x and y over z, is in the image, as a share of its width and height.
std::array<double, 2> share_of(const FrameSpec& spec, double x, double y) {
  return {(spec.camera.center_px[0] + spec.camera.focal_px[0] * x + 0.5) / spec.render.width,
          (spec.camera.center_px[1] - spec.camera.focal_px[1] * y + 0.5) / spec.render.height};
}

TEST(ScaledView, ShowsTheSameInOtherPixels) {
  for (const double scale : {0.5, 0.25, 2.0, 1.0}) {
    const FrameSpec scaled = scaled_view(view(), scale);
    EXPECT_EQ(scaled.render.width, 640 * scale);
    EXPECT_EQ(scaled.render.height, 480 * scale);
    EXPECT_FALSE(scaled.render.region);
    for (const double x : {-0.3, 0.0, 0.2}) {
      EXPECT_NEAR(share_of(scaled, x, x)[0], share_of(view(), x, x)[0], 1e-12);
      EXPECT_NEAR(share_of(scaled, x, x)[1], share_of(view(), x, x)[1], 1e-12);
    }
  }
}

TEST(ScaledView, HasAPixelAtLeast) {
  EXPECT_EQ(scaled_view(view(), 1e-6).render.width, 1);
  EXPECT_EQ(scaled_view(view(), 1e-6).render.height, 1);
}

}  // namespace
}  // namespace seedframe
