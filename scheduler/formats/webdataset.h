// Tar shards for WebDataset (docs/formats/webdataset.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

Result<std::unique_ptr<ExportFormat>> make_webdataset(const Dataset& dataset,
                                                      const ExportOptions& options);

}  // namespace seedframe
