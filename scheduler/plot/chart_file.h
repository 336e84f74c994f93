// Charts as files: SVG for pages, PNG for whatever shows no SVG.
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "plot/chart.h"

namespace seedframe {

/// Of the whole picture, legend included.
struct ChartSize {
  int width_px = 900;
  int height_px = 560;
};

/// Writes `chart` as an SVG or, at twice as many pixels, as a PNG: what the path's ending says
/// (asserted). Letters are drawn as outlines, so the file looks the same everywhere; they are of
/// the machine's sans-serif font. kEnvironment error: the file cannot be written.
Status write_chart(const Chart& chart, const std::filesystem::path& path,
                   const ChartSize& size = {});

/// Several charts as one picture, `columns` of them in a row, each of `size`; like write_chart.
Status write_charts(const std::vector<Chart>& charts, int columns,
                    const std::filesystem::path& path, const ChartSize& size);

}  // namespace seedframe
