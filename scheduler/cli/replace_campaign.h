// submit --overwrite: a campaign gives way to a new one.
#pragma once

#include <filesystem>

#include "base/error.h"

namespace seedframe {

/// Removes the campaign in `folder`, if there is one, after saying what would be lost and, without
/// `yes`, asking at the terminal. kInput errors, and nothing was removed: no; nobody to ask; the
/// folder holds files that are not the campaign's, or a campaign that another process works on.
Status clear_for_new_campaign(const std::filesystem::path& folder, bool yes);

}  // namespace seedframe
