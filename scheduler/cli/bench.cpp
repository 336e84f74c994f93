// seedframe bench: measurements that users can repeat on their own machine.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/files.h"
#include "campaign/color_config.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"
#include "study/study.h"
#include "study/study_report.h"

namespace seedframe {
namespace {

struct DeterminismArguments {
  std::string output = "results/determinism";
  std::string blender = "blender";
  int width = 160;
  int most_samples = 256;
};

Result<std::vector<StudyRow>> measure(Study& study, const std::vector<StudyCondition>& conditions) {
  std::vector<StudyRow> rows;
  rows.reserve(conditions.size());
  for (const StudyCondition& condition : conditions) {
    std::fprintf(stderr, "%s\n", condition.name.c_str());
    Result<StudyRow> row = study.measure(condition);
    if (!row) return forward_error(row);
    rows.push_back(std::move(*row));
  }
  return rows;
}

int bench_determinism(const DeterminismArguments& arguments) {
  const Result<BlenderInfo> blender = probe_blender(arguments.blender);
  if (!blender) return report(blender.error());
  const auto config = find_ocio_config(blender->program, blender->major, blender->minor);
  if (!config) return report(config.error());
  const Result<ColorManagement> color = ColorManagement::load(*config);
  if (!color) return report(color.error());
  const std::filesystem::path folder = arguments.output;
  if (Status made = make_folders(folder); !made) return report(made.error());
  std::error_code ignored;
  const auto scratch = std::filesystem::absolute(folder, ignored) / "work";
  constexpr int kAspect[] = {4, 3};
  const int height = arguments.width * kAspect[1] / kAspect[0];
  Study study({*blender, seedframe_home() / "blender_scripts", worker_preload(), scratch,
               arguments.width, height},
              *color);
  StudyResult result;
  result.width = arguments.width;
  result.height = height;
  auto conditions = measure(study, study_conditions());
  if (!conditions) return report(conditions.error());
  result.conditions = std::move(*conditions);
  // The last condition chose its kernels: ask once more.
  if (auto plain = study.measure({"", {}, {}, 1}); !plain) return report(plain.error());
  const Result<std::string> made_with = study.made_with();
  if (!made_with) return report(made_with.error());
  result.made_with = *made_with;
  auto samples = measure(study, sample_conditions(arguments.most_samples));
  if (!samples) return report(samples.error());
  result.samples = std::move(*samples);
  for (const auto& [name, text] :
       {std::pair("study.md", study_markdown(result)), std::pair("study.svg", study_plot(result)),
        std::pair("study.json", readable_json(to_json(result)))}) {
    if (Status written = write_file_atomically(folder / name, text); !written) {
      return report(written.error());
    }
  }
  std::filesystem::remove_all(scratch, ignored);
  fmt::print("{} has study.md, study.svg and study.json\n", folder.string());
  return kExitOk;
}

}  // namespace

void add_bench_verb(CLI::App& app, const OnSelected& on_selected) {
  CLI::App* bench = app.add_subcommand("bench", "measurements to repeat on your own machine");
  bench->require_subcommand(1);
  auto arguments = std::make_shared<DeterminismArguments>();
  CLI::App* verb = bench->add_subcommand(
      "determinism", "what changes Cycles' pixels: nine scenes in many conditions (minutes)");
  verb->add_option("-o,--output", arguments->output, "folder for the tables and the plot")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--blender", arguments->blender, "Blender: a path, or a name in PATH")
      ->capture_default_str();
  verb->add_option("--width", arguments->width,
                   "of the pictures; the height is three quarters of it")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  verb->add_option("--most-samples", arguments->most_samples, "up to which samples are raised")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  verb->footer("Example: seedframe bench determinism -o results/determinism");
  verb->callback([arguments, on_selected] {
    on_selected([arguments] { return bench_determinism(*arguments); });
  });
}

}  // namespace seedframe
