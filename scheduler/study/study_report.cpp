#include "study/study_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace seedframe {
namespace {

std::string percent(double share) {
  constexpr double kWhole = 100.0;
  constexpr double kSmall = 0.1;
  const double value = kWhole * share;
  return value > 0.0 && value < kSmall ? "<0.1 %" : fmt::format("{:.1f} %", value);
}

/// "0.2 % · 0.031 · 1e-04": share of pixels, greatest and root mean square difference.
std::string difference_text(const ImageDifference& difference, int digits) {
  if (difference.differing == 0) return "=";
  return fmt::format("{} · {:.{}g} · {:.1g}", percent(difference.differing_share()), difference.max,
                     digits, difference.rms);
}

std::string linear_text(const StudyCell& cell) {
  std::string text = difference_text(cell.linear, 2);
  if (cell.other_ids > 0) text += fmt::format("; **{} ids**", cell.other_ids);
  if (cell.linear.differing > 0) return text;
  if (cell.other_depths > 0) text += fmt::format("; {} depths", cell.other_depths);
  if (cell.other_normals > 0) text += fmt::format("; {} normals", cell.other_normals);
  return text;
}

std::string display_text(const StudyCell& cell) { return difference_text(cell.display, 3); }

std::string matrix(const std::vector<StudyRow>& rows, std::string (*text_of)(const StudyCell&)) {
  std::string text = "| |";
  for (const std::string& scene : study_scenes()) text += fmt::format(" {} |", scene);
  text += "\n|---|";
  for (std::size_t i = 0; i < study_scenes().size(); ++i) text += "---|";
  for (const StudyRow& row : rows) {
    text += fmt::format("\n| {} |", row.condition.name);
    for (const StudyCell& cell : row.cells) text += fmt::format(" {} |", text_of(cell));
  }
  return text + "\n";
}

std::int64_t other_ids(const std::vector<StudyRow>& rows) {
  std::int64_t sum = 0;
  for (const StudyRow& row : rows) {
    for (const StudyCell& cell : row.cells) sum += cell.other_ids;
  }
  return sum;
}

Darkness darkness_of(const std::vector<StudyRow>& rows) {
  Darkness sum;
  for (const StudyRow& row : rows) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i].pixels += row.darkness[i].pixels;
      sum[i].differing_linear += row.darkness[i].differing_linear;
      sum[i].differing_display += row.darkness[i].differing_display;
      sum[i].sum_absolute += row.darkness[i].sum_absolute;
      sum[i].sum_relative += row.darkness[i].sum_relative;
    }
  }
  return sum;
}

std::string darkness_table(const std::vector<StudyRow>& rows) {
  constexpr int kBin = 64;
  std::string text =
      "| brightest of R, G, B in 8 bits | pixels | differ, scene-linear | differ, 8 bits | mean "
      "difference of "
      "those that differ | relative |\n|---|---:|---:|---:|---:|---:|\n";
  const Darkness darkness = darkness_of(rows);
  for (std::size_t i = 0; i < darkness.size(); ++i) {
    const DarknessBin& bin = darkness[i];
    if (bin.pixels == 0) continue;
    const auto pixels = static_cast<double>(bin.pixels);
    const auto differing = static_cast<double>(std::max<std::int64_t>(1, bin.differing_linear));
    text += fmt::format("| {} to {} | {} | {} | {} | {:.2g} | {} |\n", kBin * static_cast<int>(i),
                        kBin * static_cast<int>(i + 1) - 1, bin.pixels,
                        percent(static_cast<double>(bin.differing_linear) / pixels),
                        percent(static_cast<double>(bin.differing_display) / pixels),
                        bin.sum_absolute / differing, percent(bin.sum_relative / differing));
  }
  return text;
}

std::vector<StudyRow> rows_of_kernels(const std::vector<StudyRow>& rows) {
  std::vector<StudyRow> some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), [](const StudyRow& row) {
    return row.condition.setting.kernels != row.condition.reference.kernels;
  });
  return some;
}

Json difference_json(const ImageDifference& difference) {
  return {{"differing", difference.differing},
          {"max", difference.max},
          {"rms", difference.rms},
          {"max_ulp", difference.max_ulp}};
}

Json rows_json(const std::vector<StudyRow>& rows) {
  Json all = Json::array();
  for (const StudyRow& row : rows) {
    Json cells = Json::object();
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const StudyCell& cell = row.cells[i];
      cells[study_scenes()[i]] = {{"linear", difference_json(cell.linear)},
                                  {"display", difference_json(cell.display)},
                                  {"other_ids", cell.other_ids},
                                  {"other_depths", cell.other_depths},
                                  {"other_normals", cell.other_normals}};
    }
    Json darkness = Json::array();
    for (const DarknessBin& bin : row.darkness) {
      darkness.push_back({{"pixels", bin.pixels},
                          {"differing_linear", bin.differing_linear},
                          {"differing_display", bin.differing_display},
                          {"sum_absolute", bin.sum_absolute},
                          {"sum_relative", bin.sum_relative}});
    }
    all.push_back({{"condition", row.condition.name},
                   {"samples", row.condition.setting.samples},
                   {"repetitions", row.condition.repetitions},
                   {"cells", cells},
                   {"darkness", darkness}});
  }
  return all;
}

/// One panel of the plot: shares over samples, a line for each scene.
class Panel {
 public:
  /// `limit` is the share at the top.
  Panel(double left, const char* title, std::vector<int> samples, double limit)
      : left_(left), title_(title), samples_(std::move(samples)), limit_(limit) {}

  std::string frame() const {
    std::string text = fmt::format(
        "<text x='{}' y='28' class='title'>{}</text>\n"
        "<rect x='{}' y='{}' width='{}' height='{}' class='frame'/>\n",
        left_, title_, left_, kTop, kWidth, kHeight);
    constexpr int kTicks = 4;
    for (int tick = 0; tick <= kTicks; ++tick) {
      const double share = limit_ * tick / kTicks;
      text += fmt::format("<text x='{}' y='{:.0f}' class='y'>{:.3g} %</text>\n", left_ - 6,
                          y(share) + 4, 100.0 * share);
      text += fmt::format("<line x1='{}' x2='{}' y1='{:.0f}' y2='{:.0f}' class='grid'/>\n", left_,
                          left_ + kWidth, y(share), y(share));
    }
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      text += fmt::format("<text x='{:.0f}' y='{}' class='x'>{}</text>\n", x(i),
                          kTop + kHeight + 18, samples_[i]);
    }
    return text + fmt::format("<text x='{:.0f}' y='{}' class='x'>samples a pixel</text>\n",
                              left_ + kWidth / 2, kTop + kHeight + 38);
  }
  std::string line(const std::vector<double>& shares, const char* color) const {
    std::string points;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      points += fmt::format("{:.1f},{:.1f} ", x(i), y(shares[i]));
    }
    return fmt::format("<polyline points='{}' stroke='{}' class='line'/>\n", points, color);
  }

  static constexpr double kTop = 44, kWidth = 300, kHeight = 240;

 private:
  double x(std::size_t i) const {
    const auto last = static_cast<double>(std::max<std::size_t>(1, samples_.size() - 1));
    return left_ + kWidth * static_cast<double>(i) / last;
  }
  double y(double share) const { return kTop + kHeight * (1.0 - share / limit_); }

  double left_;
  const char* title_;
  std::vector<int> samples_;
  double limit_;
};

/// The next of 1, 2, 4 and 8 % and so on.
double limit_above(const std::vector<StudyRow>& rows, ImageDifference StudyCell::*which) {
  double limit = 0.01;
  for (const StudyRow& row : rows) {
    for (const StudyCell& cell : row.cells) {
      while (limit < (cell.*which).differing_share()) limit *= 2.0;
    }
  }
  return std::min(limit, 1.0);
}

constexpr std::array<const char*, 9> kColors = {"#1f77b4", "#ff7f0e", "#2ca02c",
                                                "#d62728", "#9467bd", "#8c564b",
                                                "#e377c2", "#555555", "#17becf"};

}  // namespace

std::string study_markdown(const StudyResult& result) {
  const std::vector<StudyRow> kernels = rows_of_kernels(result.samples);
  const std::int64_t ids = other_ids(result.conditions) + other_ids(result.samples);
  std::string text = "# What changes Cycles' pixels\n\n";
  text += fmt::format(
      "Made by `seedframe bench determinism`: {}. Nine scenes of {} × {} pixels\n"
      "(`blender_scripts/study/study_scenes.py`), each rendered twice in conditions that differ in "
      "what the row "
      "says.\n\n",
      result.made_with, result.width, result.height);
  text +=
      "`=`: identical, to the last bit. Otherwise: share of pixels that differ · greatest "
      "difference · root mean square over the picture.\nWhere the colours are equal but depth or "
      "normals are not, their pixels are counted. Of conditions whose outcome\nmay be chance the "
      "worst of three runs.\n\n";
  text += fmt::format(
      "Pixels with another id in the index pass, over all of this page: **{}**.\n\n", ids);
  text += "## Conditions, at 16 samples\n\nScene-linear (half floats):\n\n" +
          matrix(result.conditions, linear_text);
  text += "\nIn 8 bits (sRGB, code values):\n\n" + matrix(result.conditions, display_text);
  text += "\n## More samples\n\nScene-linear:\n\n" + matrix(result.samples, linear_text);
  text += "\nIn 8 bits:\n\n" + matrix(result.samples, display_text);
  text += "\n![Share of pixels that differ, over samples](study.svg)\n";
  text +=
      "\n## Dark regions\n\nPixels by how bright they are, over all scenes and numbers of samples, "
      "between kernels "
      "for AVX and the best of the CPU:\n\n" +
      darkness_table(kernels);
  return text;
}

Json to_json(const StudyResult& result) {
  return {{"version", 1},
          {"made_with", result.made_with},
          {"width", result.width},
          {"height", result.height},
          {"conditions", rows_json(result.conditions)},
          {"samples", rows_json(result.samples)}};
}

std::string study_plot(const StudyResult& result) {
  const std::vector<StudyRow> rows = rows_of_kernels(result.samples);
  std::vector<int> samples;
  samples.reserve(rows.size());
  for (const StudyRow& row : rows) samples.push_back(row.condition.setting.samples);
  std::string text =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 860 344' font-family='sans-serif'>\n"
      "<style>text{font-size:12px;fill:#333}.title{font-size:14px}.y{text-anchor:end}.x{text-"
      "anchor:middle}"
      ".frame{fill:none;stroke:#888}.grid{stroke:#ddd}.line{fill:none;stroke-width:2}</style>\n"
      "<rect width='860' height='344' fill='white'/>\n";
  const Panel linear(56, "pixels that differ, scene-linear half floats", samples,
                     limit_above(rows, &StudyCell::linear));
  const Panel display(424, "pixels that differ, 8 bits", samples,
                      limit_above(rows, &StudyCell::display));
  text += linear.frame() + display.frame();
  for (std::size_t scene = 0; scene < study_scenes().size(); ++scene) {
    std::vector<double> shares;
    std::vector<double> display_shares;
    shares.reserve(rows.size());
    display_shares.reserve(rows.size());
    for (const StudyRow& row : rows) {
      shares.push_back(row.cells[scene].linear.differing_share());
      display_shares.push_back(row.cells[scene].display.differing_share());
    }
    const char* color = kColors[scene % kColors.size()];
    text += linear.line(shares, color) + display.line(display_shares, color);
    const double y = Panel::kTop + 12 + 20 * static_cast<double>(scene);
    text += fmt::format(
        "<line x1='738' x2='756' y1='{}' y2='{}' stroke='{}' class='line'/><text x='762' "
        "y='{}'>{}</text>\n",
        y, y, color, y + 4, study_scenes()[scene]);
  }
  return text + "</svg>\n";
}

}  // namespace seedframe
