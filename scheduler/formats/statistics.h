// Numbers about a dataset (docs/formats/statistics.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

Result<std::unique_ptr<ExportFormat>> make_statistics(const Dataset& dataset,
                                                      const ExportOptions& options);

}  // namespace seedframe
