// BOP: 6D poses, depth, full and visible masks, models (docs/formats/bop.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

Result<std::unique_ptr<ExportFormat>> make_bop(const Dataset& dataset,
                                               const ExportOptions& options);

}  // namespace seedframe
