// The sources of pages, as cmake/embed.cmake puts them into the program.
#pragma once

#include <string_view>

namespace seedframe::web {

// NOLINTBEGIN(readability-identifier-naming): clang-tidy takes no constant of another file for one
extern const std::string_view kTemplate;      ///< index.html, with {{names}} for what is put in
extern const std::string_view kStyle;         ///< page.css
extern const std::string_view kScript;        ///< our own scripts, one behind the other
extern const std::string_view kChart;         ///< Chart.js
extern const std::string_view kChartLicense;  ///< its licence
// NOLINTEND(readability-identifier-naming)

}  // namespace seedframe::web
