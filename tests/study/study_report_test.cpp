// What the determinism study tells of made-up measurements.

#include "study/study_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

StudyRow row_of(const std::string& name, int samples, std::int64_t differing) {
  StudyRow row;
  row.condition.name = name;
  row.condition.setting.samples = samples;
  row.condition.setting.kernels = kernels_of(Isa::kAvx);
  row.cells.resize(study_scenes().size());
  for (StudyCell& cell : row.cells) cell.linear.pixels = cell.display.pixels = 1000;
  row.cells[1].linear.differing = differing;
  row.cells[1].linear.max = 0.25;
  row.cells[1].linear.rms = 0.001;
  row.darkness[0] = {100, differing, 1, 0.5, 2.0};
  return row;
}

StudyResult small_result() {
  StudyResult result;
  result.width = 40;
  result.height = 25;
  result.made_with = "Blender 3.4.1";
  result.conditions = {row_of("again", 16, 0), row_of("another CPU", 16, 420)};
  result.samples = {row_of("1 sample", 1, 900), row_of("4 samples", 4, 450)};
  return result;
}

TEST(StudyReport, ACellIsEqualOrSaysHowFarItIs) {
  const std::string text = study_markdown(small_result());
  EXPECT_THAT(text, HasSubstr("| again | = | = | = | = | = | = | = | = | = |"));
  EXPECT_THAT(text, HasSubstr("| another CPU | = | 42.0 % · 0.25 · 0.001 | ="));
  EXPECT_THAT(text, HasSubstr("over all of this page: **0**"));
}

TEST(StudyReport, OtherIdsAreAlwaysSaid) {
  StudyResult result = small_result();
  result.conditions[0].cells[3].other_ids = 7;
  const std::string text = study_markdown(result);
  EXPECT_THAT(text, HasSubstr("**7 ids**"));
  EXPECT_THAT(text, HasSubstr("over all of this page: **7**"));
}

TEST(StudyReport, NormalsAreToldWhereColoursAreEqual) {
  StudyResult result = small_result();
  result.conditions[0].cells[0].other_normals = 12;
  result.conditions[1].cells[1].other_normals = 12;
  const std::string text = study_markdown(result);
  EXPECT_THAT(text, HasSubstr("| again | =; 12 normals |"));
  EXPECT_THAT(text, Not(HasSubstr("0.001; 12 normals")));
}

TEST(StudyReport, ThePlotHasALineForEachSceneInBothPanels) {
  const std::string plot = study_plot(small_result());
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = plot.find("<polyline", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 2 * study_scenes().size());
  EXPECT_THAT(plot, HasSubstr("many lights"));
}

TEST(StudyReport, DarknessIsSummedOverScenesAndSamples) {
  EXPECT_THAT(study_markdown(small_result()), HasSubstr("| 0 to 63 | 200 | 675.0 % | 1.0 % |"));
  EXPECT_EQ(to_json(small_result()).at("samples").size(), 2u);
}

}  // namespace
}  // namespace seedframe
