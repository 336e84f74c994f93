// Tests that hold for every export format: each gets a campaign of ten frames and its format's
// name.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "export/verify.h"
#include "formats/formats.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {

inline const std::vector<std::string> kFormats = {
    "coco",         "coco-polygon", "coco-keypoints", "coco-panoptic", "yolo-detect",
    "yolo-segment", "yolo-obb",     "yolo-pose",      "voc",           "bop",
    "patches",      "webdataset",   "statistics"};

/// As suites of tests may be called.
inline std::string name_of_format(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class EveryFormat : public ::testing::TestWithParam<std::string> {
 protected:
  EveryFormat() : campaign_(scratch_.path() / "campaign") {
    campaign_.dataset().seed = 2;
    campaign_.add_ten_frames();
    for (const char* name : {"bolt", "gear", "hidden", "nut", "rock"}) {
      auto asset = std::make_shared<Asset>();
      asset->name = name;
      asset->mesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.2F, 0}};
      asset->mesh.triangles = {{0, 1, 2}};
      campaign_.dataset().assets.push_back({asset, {}});
    }
  }

  Result<ExportSummary> run(const ExportOptions& options) {
    return export_one(campaign_.dataset(), GetParam(), options);
  }
  ExportOptions options() const { return {.output = output()}; }
  ExportOptions split_options() const {
    ExportOptions options{.output = output()};
    options.splits = {{"train", 0.6}, {"val", 0.4}};
    return options;
  }
  fs::path output() const { return scratch_.path() / "out"; }
  fs::path folder() const { return output() / GetParam(); }
  VerifySummary verified() {
    const auto summary = verify_export(campaign_.dataset(), export_formats(), folder(), 2);
    EXPECT_TRUE(summary) << summary.error().message;
    return summary ? *summary : VerifySummary{};
  }
  bool is_reused() const { return GetParam() != "statistics"; }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

}  // namespace seedframe
