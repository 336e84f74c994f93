// Images of single objects for classifiers (docs/formats/patches.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

/// A kInput error for a dataset without images.
Result<std::unique_ptr<ExportFormat>> make_patches(const Dataset& dataset,
                                                   const ExportOptions& options);

}  // namespace seedframe
