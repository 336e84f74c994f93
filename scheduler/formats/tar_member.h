// Members of a tar archive: POSIX ustar, the same bytes for the same content.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// Header and padded content of a file with mode 0644, owner 0 and time 0. An archive is the
/// concatenation of its members and tar_end(). A name is at most 100 bytes.
Result<std::string> tar_member(const std::string& name, std::string_view content);

/// Two blocks of zeros.
std::string tar_end();

/// Names and contents of the members; none if the text is not members only.
std::optional<std::vector<std::pair<std::string, std::string>>> read_tar_members(
    const std::string& members);

}  // namespace seedframe
