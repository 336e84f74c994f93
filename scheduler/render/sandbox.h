// Workers that see the disk read-only but for one folder, and no network: by bubblewrap.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// The beginning of a command line that starts what follows it in a sandbox: everything read-only
/// but `output`; its own /dev, /proc and process numbers; no network, no
/// capabilities, no socket of another program, and an end when we end. /tmp, /run and /var/tmp are
/// empty there but for `output` and what is `readable`.
std::vector<std::string> sandbox_arguments(const std::filesystem::path& output,
                                           const std::vector<std::filesystem::path>& readable);

/// Tries it: kEnvironment when bubblewrap is missing, or the system lets nobody make namespaces.
Status check_sandbox();

}  // namespace seedframe
