#include "plan/frame_bytes.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

double bytes_of(const CampaignSettings& settings) {
  return static_cast<double>(typical_frame_bytes(settings));
}

CampaignSettings labels_of(int width, int height) {
  CampaignSettings settings;
  settings.render.width = width;
  settings.render.height = height;
  settings.labels = LabelSource::kTwin;
  return settings;
}

TEST(FrameBytes, AreAboutWhatWasMeasured) {
  CampaignSettings parts = labels_of(320, 240);
  parts.labels = LabelSource::kIndexPass;
  parts.render.depth = parts.render.normal = true;
  EXPECT_NEAR(bytes_of(parts), 2.78e6, 0.05e6);
}

TEST(FrameBytes, LabelsAloneTakeLittleWhateverTheSize) {
  EXPECT_EQ(bytes_of(labels_of(16384, 16384)), bytes_of(labels_of(16, 16)));
}

TEST(FrameBytes, EachPassTakesRoom) {
  CampaignSettings settings = labels_of(1000, 1000);
  double bytes = bytes_of(settings);
  const auto expect_more = [&] {
    EXPECT_GT(bytes_of(settings), bytes + 1e6);
    bytes = bytes_of(settings);
  };
  settings.render.depth = true;
  expect_more();
  settings.render.normal = true;
  expect_more();
  settings.labels = LabelSource::kIndexPass;
  expect_more();
}

TEST(FrameBytes, AreMoreThanFitInto32Bits) {
  CampaignSettings settings = labels_of(16384, 16384);
  settings.labels = LabelSource::kIndexPass;
  EXPECT_GT(bytes_of(settings), 2.5e9);
  settings.render.depth = settings.render.normal = true;
  EXPECT_NEAR(bytes_of(settings), 9.6e9, 0.1e9);
}

TEST(FrameBytes, AJpegTakesLessThanAPng) {
  CampaignSettings settings = labels_of(1000, 1000);
  settings.labels = LabelSource::kIndexPass;
  const double png = bytes_of(settings);
  settings.image_encoding.format = ImageFormat::kJpeg;
  EXPECT_NEAR(png - bytes_of(settings), 1.5e6, 1e3);
}

}  // namespace
}  // namespace seedframe
