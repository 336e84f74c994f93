// The list of export formats.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "export/format.h"

namespace seedframe {

struct FormatEntry {
  const char* name;
  const char* description;
  /// kInput errors for a dataset or options that the format cannot hold.
  Result<std::unique_ptr<ExportFormat>> (*make)(const Dataset&, const ExportOptions&);
};

const std::vector<FormatEntry>& export_formats();

/// A kInput error with "did you mean" for an unknown name.
Result<const FormatEntry*> find_export_format(std::string_view name);

}  // namespace seedframe
