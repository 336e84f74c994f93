#include "quality/error_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/files.h"
#include "plot/chart_file.h"
#include "quality/choice.h"
#include "quality/error_chart.h"

namespace seedframe {
namespace {

/// In which the charts are made: what pixels are off by, what renderers are compared by, and what
/// somebody sees.
constexpr std::array<const char*, 3> kCharted = {"rmse8", "relmse", "flip"};

std::string settings_text(const Variation& variation) {
  std::string text;
  for (const Override& each : variation.set) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", each.path, each.value);
  }
  return text;
}

std::string chart_name(const std::string& scene, const std::string& measure) {
  return scene + "_" + measure;
}

/// What a user would add to a config to have it instead of plain samples, as one cell.
std::string advice_cell(const Choice& choice, const Choice& plain) {
  if (choice.name == plain.name) return "nothing cheaper";
  return fmt::format("{}: **{:.2f}**", choice.name, choice.at.cost / plain.at.cost);
}

std::string advice_table(const std::vector<Choice>& choices, const Measure& measure,
                         const char* cost) {
  std::string text = fmt::format(
      "| for the {} of | {} | {} | cheapest without a denoiser: share of that | cheapest of all |\n"
      "|---|---:|---:|---|---|\n",
      measure.key, measure.key, cost);
  for (const Advice& advice : advice_for(choices)) {
    text += fmt::format("| {} | {:.3g} | {:.3g} | {} | {} |\n", advice.plain.name,
                        advice.plain.at.error, advice.plain.at.cost,
                        advice_cell(advice.exact, advice.plain),
                        advice_cell(advice.denoised, advice.plain));
  }
  return text;
}

std::string figures_table(const SceneStudy& scene) {
  std::string text =
      "| variation | CPU s | rmse8 | relMSE | FLIP | SSIM | bias, codes | edge noise / contrast | "
      "edges kept |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const MeasuredVariation& measured : scene.variations) {
    if (!measured.left_out.empty()) continue;
    const RenderingError error = measured.error();
    text += fmt::format(
        "| {} | {:.3f} | {:.2f} | {:.2g} | {:.4f} | {:.4f} | {:+.2f} | {:.1f} / {:.1f} | {:.3f} "
        "|\n",
        measured.variation.name, measured.cpu_s(), error.display.rmse(),
        error.linear.squared.rel_mse, error.display.flip, error.display.ssim.value_or(1.0),
        error.display.bias, error.edges.noise(), error.edges.contrast, error.edges.kept);
  }
  return text;
}

/// By reason, in the order in which these first come.
std::string left_out_text(const SceneStudy& scene) {
  std::vector<std::pair<std::string, std::string>> reasons;  ///< with the names of variations
  for (const MeasuredVariation& measured : scene.variations) {
    if (measured.left_out.empty()) continue;
    const auto known = std::find_if(reasons.begin(), reasons.end(), [&](const auto& reason) {
      return reason.first == measured.left_out;
    });
    if (known == reasons.end()) {
      reasons.emplace_back(measured.left_out, measured.variation.name);
    } else {
      known->second += "; " + measured.variation.name;
    }
  }
  std::string text;
  for (const auto& [reason, names] : reasons) text += fmt::format("- {}: {}\n", reason, names);
  return text.empty() ? text : "Left out:\n\n" + text;
}

std::string scene_section(const SceneStudy& scene) {
  const Measure& codes = measure_named("rmse8");
  std::string frames;
  for (const std::int64_t frame : scene.frames) {
    frames += fmt::format("{}{}", frames.empty() ? "" : ", ", frame);
  }
  std::string text = fmt::format(
      "\n## {}\n\n{} × {} pixels, frames {}. References: two halves of {} samples with seeds of "
      "their own ({:.1f} CPU s a frame); what is left of noise in their mean, rmse8 {:.2f} and "
      "relMSE {:.2g}, is subtracted.\n\n",
      scene.name, scene.width, scene.height, frames, scene.reference_samples / 2,
      scene.reference_cpu_s, std::sqrt(scene.reference.display), scene.reference.linear.rel_mse);
  for (const char* key : kCharted) {
    text += fmt::format("![{} of {} over CPU time]({}.svg)\n", key, scene.name,
                        chart_name(scene.name, key));
  }
  text += "\n" + advice_table(choices_of(scene, codes), codes, "CPU s");
  text += "\n" + figures_table(scene) + "\n" + left_out_text(scene);
  return text;
}

Json to_json(const MeasuredFrame& frame) {
  const RenderingError& error = frame.error;
  Json json = {{"cpu_s", frame.cpu_s}, {"wall_s", frame.wall_s}};
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) json[key] = value;  // JSON has no other numbers
  };
  add("rmse", error.linear.squared.rmse());
  add("luminance_bias", error.linear.luminance_bias);
  add("psnr_db", error.display.psnr_db());
  add("display_bias", error.display.bias);
  add("edge_contrast", error.edges.contrast);
  add("edges_kept", error.edges.kept);
  if (error.display.ssim) add("ssim", *error.display.ssim);
  for (const Measure& measure : measures()) add(measure.key, measure.of(error));
  return json;
}

Json to_json(const MeasuredVariation& measured) {
  Json frames = Json::array();
  for (const MeasuredFrame& frame : measured.frames) frames.push_back(to_json(frame));
  Json set = Json::object();
  for (const Override& each : measured.variation.set) set[each.path] = each.value;
  Json json = {{"name", measured.variation.name},
               {"lever", name_of(measured.variation.lever)},
               {"set", set},
               {"frames", frames}};
  if (!measured.left_out.empty()) json["left_out"] = measured.left_out;
  return json;
}

Json to_json(const SceneStudy& scene) {
  Json variations = Json::array();
  for (const MeasuredVariation& each : scene.variations) variations.push_back(to_json(each));
  return {{"name", scene.name},
          {"width", scene.width},
          {"height", scene.height},
          {"frames", scene.frames},
          {"reference_samples", scene.reference_samples},
          {"reference_cpu_s", scene.reference_cpu_s},
          {"variations", variations}};
}

Status write_charts(const std::string& scene, const std::string& title,
                    const std::function<std::vector<Choice>(const Measure&)>& choices,
                    bool relative, const std::filesystem::path& folder) {
  for (const char* key : kCharted) {
    const Measure& measure = measure_named(key);
    const Chart chart = error_chart(title, choices(measure), measure, relative);
    for (const char* ending : {".svg", ".png"}) {
      Status written = write_chart(chart, folder / (chart_name(scene, key) + ending));
      if (!written) return written;
    }
  }
  return {};
}

}  // namespace

std::string error_csv(const ErrorReport& report) {
  std::string text = "scene,variation,lever,settings,frame,cpu_s,wall_s,bias";
  for (const Measure& measure : measures()) text += fmt::format(",{}", measure.key);
  text += "\n";
  for (const SceneStudy& scene : report.scenes) {
    for (const MeasuredVariation& measured : scene.variations) {
      for (std::size_t i = 0; i < measured.frames.size(); ++i) {
        const MeasuredFrame& frame = measured.frames[i];
        text += fmt::format("{},\"{}\",\"{}\",\"{}\",{},{:.4f},{:.4f},{:.4f}", scene.name,
                            measured.variation.name, name_of(measured.variation.lever),
                            settings_text(measured.variation), scene.frames[i], frame.cpu_s,
                            frame.wall_s, frame.error.display.bias);
        for (const Measure& measure : measures()) {
          text += fmt::format(",{:.6g}", measure.of(frame.error));
        }
        text += "\n";
      }
    }
  }
  return text;
}

Json to_json(const ErrorReport& report) {
  Json scenes = Json::array();
  for (const SceneStudy& scene : report.scenes) scenes.push_back(to_json(scene));
  return {{"version", 1}, {"made_with", report.made_with}, {"scenes", scenes}};
}

std::string error_page(const ErrorReport& report) {
  std::string text = fmt::format(
      "# Error against run time\n\nMade by `seedframe bench error`: {}.\n\n"
      "Each variation renders the same pilot frames, in one warm worker; CPU seconds are those of "
      "all its threads, from the request to the file. Errors are told in "
      "[several measures](../../../docs/error_metrics.md), means over the frames. A variation is "
      "*on the front* if no other is at most as dear and at most as wrong. What a variation sets "
      "is in `error.csv`, to be said in a config or with `--set`.\n",
      report.made_with);
  const Measure& codes = measure_named("rmse8");
  const std::vector<Choice> overall = choices_overall(report.scenes, codes);
  if (report.scenes.size() > 1 && !overall.empty()) {
    text += fmt::format(
        "\n## Over all scenes\n\nGeometric means of cost and error relative to {} plain samples of "
        "the same frame.\n\n",
        kOverallSamples);
    for (const char* key : kCharted) {
      text += fmt::format("![{} over CPU time]({}.svg)\n", key, chart_name("overall", key));
    }
    text += "\n" + advice_table(overall, codes, "CPU time");
  }
  for (const SceneStudy& scene : report.scenes) text += scene_section(scene);
  return text;
}

Status write_error_report(const ErrorReport& report, const std::filesystem::path& folder) {
  if (Status made = make_folders(folder); !made) return made;
  const std::array<std::pair<const char*, std::string>, 3> texts = {
      {{"error.md", error_page(report)},
       {"error.csv", error_csv(report)},
       {"error.json", readable_json(to_json(report))}}};
  for (const auto& [name, text] : texts) {
    if (Status written = write_file(folder / name, text); !written) return written;
  }
  for (const SceneStudy& scene : report.scenes) {
    Status drawn = write_charts(
        scene.name, fmt::format("{}: error over run time", scene.name),
        [&](const Measure& measure) { return choices_of(scene, measure); }, false, folder);
    if (!drawn) return drawn;
  }
  if (report.scenes.size() < 2) return {};
  return write_charts(
      "overall", "all scenes: error over run time",
      [&](const Measure& measure) { return choices_overall(report.scenes, measure); }, true,
      folder);
}

}  // namespace seedframe
