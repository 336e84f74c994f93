// Wrong pixels and depth errors over every axis, in one picture.
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "tests/stability/figures.h"

namespace seedframe {

/// As SVG or PNG, by the ending. Cases without a place on their axis are left out.
Status write_stability_chart(const std::vector<CaseFigures>& cases,
                             const std::filesystem::path& path);

}  // namespace seedframe
