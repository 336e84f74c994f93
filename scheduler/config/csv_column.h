// Numbers of one column of a CSV file (RFC 4180): an empirical distribution.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// Sorted. The first line names the columns. Errors (kInput): no such file or column (with "did you
/// mean"), no rows, a row whose cell is not a finite number (with its line), too large a file.
Result<std::vector<double>> read_csv_column(const std::filesystem::path& file,
                                            const std::string& column);

}  // namespace seedframe
