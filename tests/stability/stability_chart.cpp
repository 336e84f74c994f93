#include "tests/stability/stability_chart.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "plot/chart_file.h"

namespace seedframe {
namespace {

/// An axis of the cases, as the charts have it.
struct ChartedAxis {
  const char* axis;
  const char* label;
  bool logarithmic;
};

constexpr std::array<ChartedAxis, 12> kAxes = {{
    {"distance from the world's origin", "metres", true},
    {"distance, not relative to the camera", "metres", true},
    {"vertices far from their mesh's origin", "metres", true},
    {"size of the scene", "size of a part, metres", true},
    {"field of view", "degrees", true},
    {"faces at a grazing angle", "degrees", true},
    {"slivers", "length / width", true},
    {"faces a gap apart", "gap at 0.5 m, metres", true},
    {"triangles of one mesh", "triangles", true},
    {"small things in large ones", "size of the room / size of a part", true},
    {"aspect of the pixels", "fy / fx", true},
    {"shift of the lens", "widths of the image", false},
}};

/// What a chart shows of an agreement, and the ends of its axis, at which what is beyond is drawn.
struct Measure {
  const char* label;
  double least, most;
  double (*value)(const AgreementFigures&);
};

constexpr double kMillion = 1e6;
constexpr std::array<Measure, 2> kMeasures = {{
    {"wrong pixels per million", 1.0, kMillion,
     [](const AgreementFigures& figures) {
       return kMillion * static_cast<double>(figures.wrong) /
              static_cast<double>(std::max<std::int64_t>(1, figures.pixels));
     }},
    {"depth error, ulp (99 %)", 0.1, kMillion,
     [](const AgreementFigures& figures) { return figures.depth_ulp.p99; }},
}};

/// Nothing when the case has no such agreement.
using AgreementOf = std::function<const AgreementFigures*(const CaseFigures&)>;

Series series_of(const std::vector<CaseFigures>& cases, const ChartedAxis& axis,
                 const Measure& measure, const AgreementOf& agreement_of) {
  Series series;
  series.line = true;
  for (const CaseFigures& each : cases) {
    const AgreementFigures* agreement = agreement_of(each);
    if (each.axis != axis.axis || !each.at || agreement == nullptr) continue;
    const double value = std::clamp(measure.value(*agreement), measure.least, measure.most);
    series.points.push_back({*each.at, value});
  }
  return series;
}

Chart chart_of(const std::vector<CaseFigures>& cases, const ChartedAxis& axis,
               const Measure& measure) {
  Chart chart;
  chart.title = axis.axis;
  chart.x = {axis.label, axis.logarithmic};
  chart.y = {measure.label, true};
  chart.legend_inside = true;
  constexpr std::array<Marker, 2> kMarkers = {Marker::kRing, Marker::kTriangle};
  const std::size_t blenders = cases.front().blenders.size();
  for (std::size_t b = 0; b < blenders; ++b) {
    Series series = series_of(cases, axis, measure, [&](const CaseFigures& each) {
      return each.blenders[b].failure.empty() ? &each.blenders[b].agreement : nullptr;
    });
    series.name = "Blender " + cases.front().blenders[b].version;
    series.marker = kMarkers[b % kMarkers.size()];
    chart.series.push_back(std::move(series));
  }
  Series twin = series_of(cases, axis, measure, [](const CaseFigures& each) { return &each.twin; });
  twin.name = "twin";
  twin.marker = Marker::kDot;
  chart.series.push_back(std::move(twin));
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    chart.series[i].color = chart_color(chart.series.size() - 1 - i);
  }
  // All charts of a measure have one scale.
  const auto& points = chart.series.back().points;
  const double x = points.empty() ? 1.0 : points.front()[0];
  Series ends;
  ends.marker = Marker::kNone;
  ends.points = {{x, measure.least}, {x, measure.most}};
  chart.series.push_back(std::move(ends));
  return chart;
}

}  // namespace

Status write_stability_chart(const std::vector<CaseFigures>& cases,
                             const std::filesystem::path& path) {
  std::vector<Chart> charts;
  for (const ChartedAxis& axis : kAxes) {
    for (const Measure& measure : kMeasures) charts.push_back(chart_of(cases, axis, measure));
  }
  for (std::size_t i = 1; i < charts.size(); ++i) {  // one legend is enough
    for (Series& series : charts[i].series) series.name.clear();
  }
  constexpr int kColumns = 4;
  return write_charts(charts, kColumns, path, {370, 260});
}

}  // namespace seedframe
