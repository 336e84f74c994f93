// image.png must look as if Blender had saved it, and the passes must mean what we say they mean.
#include "image/color_management.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/files.h"
#include "image/pass_reader.h"
#include "image/png_file.h"
#include "tests/fixtures/real_blender.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

// As in color_reference.py.
constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kChartId = 7;
constexpr int kTiltedId = 300;
constexpr float kChartDistance = 4.0F;
constexpr float kTilt = 0.5F;

struct Reference {
  std::string file;
  ImageSettings settings;
};

class RealBlenderColor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    folder_ = scratch_->path();
    const fs::path script =
        fs::path(SEEDFRAME_HOME) / "tests" / "image" / "blender" / "color_reference.py";
    const fs::path log = folder_ / "log.txt";
    ASSERT_EQ(run_in_blender(script, folder_.string(), log), 0) << *read_file(log);
    auto passes = read_passes(folder_ / "passes.exr", {kWidth, kHeight, true, true, kTiltedId});
    ASSERT_TRUE(passes) << passes.error().message;
    passes_ = new FramePasses(std::move(*passes));
  }
  static void TearDownTestSuite() {
    delete passes_;
    passes_ = nullptr;
    delete scratch_;
  }

  static std::vector<Reference> references() {
    std::vector<Reference> all;
    std::istringstream table(*read_file(folder_ / "references.txt"));
    for (std::string line; std::getline(table, line);) {
      std::istringstream columns(line);
      Reference reference;
      reference.settings.display = "sRGB";
      std::string exposure, gamma;
      std::getline(columns, reference.file, '\t');
      std::getline(columns, reference.settings.view, '\t');
      std::getline(columns, reference.settings.look, '\t');
      std::getline(columns, exposure, '\t');
      std::getline(columns, gamma, '\t');
      reference.settings.exposure_stops = std::stod(exposure);
      reference.settings.gamma = std::stod(gamma);
      all.push_back(reference);
    }
    return all;
  }

  static inline ScratchFolder* scratch_ = nullptr;
  static inline fs::path folder_;
  static inline FramePasses* passes_ = nullptr;
};

TEST_F(RealBlenderColor, PicturesEqualBlendersOwnWithinOneCodeValue) {
  const auto colors = ColorManagement::load(*read_file(folder_ / "config.txt"));
  ASSERT_TRUE(colors) << colors.error().message;
  const std::vector<Reference> all = references();
  // Two views with two looks, three exposures and gammas each; one more view since Blender 4.
  const auto blender = probe_blender(test_blender());
  ASSERT_TRUE(blender);
  ASSERT_EQ(all.size(), blender->major < 4 ? 12U : 18U);
  for (const Reference& reference : all) {
    const ImageSettings& settings = reference.settings;
    SCOPED_TRACE(fmt::format("view {}, look {}, exposure {}, gamma {}", settings.view,
                             settings.look, settings.exposure_stops, settings.gamma));
    const auto blenders = read_png8(folder_ / reference.file);
    ASSERT_TRUE(blenders) << blenders.error().message;
    const auto ours = colors->apply(passes_->combined, settings);
    ASSERT_TRUE(ours) << ours.error().message;
    ASSERT_EQ(ours->values.size(), blenders->values.size());
    int largest = 0;
    for (std::size_t i = 0; i < ours->values.size(); ++i) {
      largest = std::max(largest, std::abs(ours->values[i] - blenders->values[i]));
    }
    EXPECT_LE(largest, 1);
    const std::set<std::uint8_t> values(ours->values.begin(), ours->values.end());
    EXPECT_GT(values.size(), 100U) << "the picture is too plain to prove anything";
  }
}

TEST_F(RealBlenderColor, TheChartIsBrightDarkAndSaturated) {
  const Image<float>& combined = passes_->combined;
  float brightest = 0.0F;
  bool dark = false, saturated = false;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      if (passes_->instance_ids.at(row, column) != kChartId) continue;
      const float* rgb = &combined.at(row, column, 0);
      const auto [low, high] = std::minmax({rgb[0], rgb[1], rgb[2]});
      brightest = std::max(brightest, high);
      dark = dark || (high > 0.0F && high < 0.002F);
      saturated = saturated || (high > 1.0F && low < 0.001F);
    }
  }
  EXPECT_GT(brightest, 18.0F);
  EXPECT_TRUE(dark);
  EXPECT_TRUE(saturated);
}

TEST_F(RealBlenderColor, IndexDepthAndNormalAreInTheCamerasFrame) {
  std::set<int> ids;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const int id = passes_->instance_ids.at(row, column);
      ids.insert(id);
      const float depth = passes_->depth->at(row, column);
      const float* normal = &passes_->normal->at(row, column, 0);
      if (id == kChartId) {
        ASSERT_NEAR(depth, kChartDistance, 1e-4F);  // planar: the same in every corner
        ASSERT_NEAR(normal[2], 1.0F, 1e-4F);
      } else if (id == kTiltedId) {
        ASSERT_NEAR(normal[0], std::sin(kTilt), 1e-4F);
        ASSERT_NEAR(normal[1], 0.0F, 1e-4F);
        ASSERT_NEAR(normal[2], std::cos(kTilt), 1e-4F);
      } else {
        ASSERT_EQ(depth, 1e10F);
        ASSERT_EQ(normal[0], 0.0F);
        ASSERT_EQ(normal[1], 0.0F);
        ASSERT_EQ(normal[2], 0.0F);
      }
    }
  }
  EXPECT_EQ(ids, (std::set<int>{0, kChartId, kTiltedId}));
}

TEST_F(RealBlenderColor, CombinedIsStoredAsHalf) {
  for (const float value : passes_->combined.values) {
    // A half has 11 significant bits: the low 13 of a float's 23 are 0.
    ASSERT_EQ(std::bit_cast<std::uint32_t>(value) & 0x1fffU, 0U);
  }
}

}  // namespace
}  // namespace seedframe
