// A study of error against run time as files: a page, charts, CSV and JSON.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "quality/error_study.h"

namespace seedframe {

struct ErrorReport {
  std::string made_with;  ///< "seedframe 0.1.0, Blender 3.4.1, 2 cores"
  std::vector<SceneStudy> scenes;
};

/// A line for each frame of each variation that was measured, after one with names.
std::string error_csv(const ErrorReport& report);
/// docs/formats/error-study.md.
Json to_json(const ErrorReport& report);
/// What to choose, and all figures.
std::string error_page(const ErrorReport& report);

/// error.md, error.csv, error.json, and of each scene and over all of them a chart in three
/// measures, as SVG and PNG.
Status write_error_report(const ErrorReport& report, const std::filesystem::path& folder);

}  // namespace seedframe
