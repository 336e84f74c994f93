// Whether a campaign's exports still say what its frames do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "export/format.h"

namespace seedframe {

/// What became of one export when it was compared with its source.
struct AuditedExport {
  std::string format;
  std::int64_t frames = 0;
  std::int64_t differences = 0;
  std::vector<std::string> first_differences;  ///< or why it could not be compared

  bool is_whole() const { return first_differences.empty(); }
};

/// Compares every export that lies in `exports`, of any of the formats, on `threads` threads.
std::vector<AuditedExport> check_exports(const Dataset& dataset, const FormatList& formats,
                                         const std::filesystem::path& exports, int threads);

}  // namespace seedframe
