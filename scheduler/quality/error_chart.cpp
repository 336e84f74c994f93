#include "quality/error_chart.h"

#include <map>

#include <fmt/format.h>

namespace seedframe {
namespace {

Marker marker_of(Lever lever) {
  switch (lever) {
    case Lever::kSamples:
      return Marker::kDot;
    case Lever::kDenoise:
    case Lever::kAdaptiveDenoise:
      return Marker::kSquare;
    case Lever::kAdaptive:
      return Marker::kTriangle;
    default:
      return Marker::kCross;
  }
}

}  // namespace

Chart error_chart(const std::string& title, const std::vector<Choice>& choices,
                  const Measure& measure, bool relative) {
  Chart chart;
  chart.title = title;
  chart.x = {relative ? fmt::format("CPU time of a frame, relative to {} samples", kOverallSamples)
                      : "CPU time of a frame, seconds",
             true};
  chart.y = {relative ? fmt::format("{}, relative to {} samples", measure.label, kOverallSamples)
                      : measure.label,
             true};
  std::map<Lever, Series> by_lever;
  for (const Choice& choice : choices) {
    Series& series = by_lever[choice.lever];
    series.name = name_of(choice.lever);
    series.color = chart_color(static_cast<std::size_t>(choice.lever));
    series.marker = marker_of(choice.lever);
    series.line = choice.lever == Lever::kSamples;
    series.points.push_back({choice.at.cost, choice.at.error});
    series.labels.push_back(choice.lever == Lever::kSamples ? std::to_string(choice.samples) : "");
  }
  Series front;
  front.name = "the best of all";
  front.color = {0.0, 0.0, 0.0};
  front.marker = Marker::kRing;
  front.line = front.dashed = true;
  front.width_px = 1.0;
  for (const std::size_t i : front_of(choices, true)) {
    front.points.push_back({choices[i].at.cost, choices[i].at.error});
  }
  for (auto& [lever, series] : by_lever) chart.series.push_back(std::move(series));
  chart.series.push_back(std::move(front));
  return chart;
}

}  // namespace seedframe
