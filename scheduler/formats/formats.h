// All export formats.
#pragma once

#include "export/format.h"

namespace seedframe {

const FormatList& export_formats();

}  // namespace seedframe
