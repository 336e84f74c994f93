// seedframe bench: measurements that users can repeat on their own machine.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/files.h"
#include "campaign/run_setup.h"
#include "cli/bench_error.h"
#include "cli/verb.h"
#include "console/blender_option.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "study/study_run.h"

namespace seedframe {
namespace {

struct DeterminismArguments {
  std::string output = "results/determinism";
  std::string blender;
  int width = 160;
  int most_samples = 256;
};

int bench_determinism(const DeterminismArguments& arguments) {
  const Result<Renderer> renderer = find_renderer(arguments.blender, nullptr, nullptr);
  if (!renderer) return report(renderer.error());
  const std::filesystem::path folder = arguments.output;
  if (Status made = make_folders(folder); !made) return report(made.error());
  std::error_code ignored;
  const auto scratch = std::filesystem::absolute(folder, ignored) / "work";
  constexpr int kAspect[] = {4, 3};
  const int height = arguments.width * kAspect[1] / kAspect[0];
  Study study({renderer->blender, seedframe_home() / "blender_scripts", worker_preload(), scratch,
               arguments.width, height},
              *renderer->color);
  Result<StudyResult> result = run_study(
      study, arguments.most_samples,
      [](const std::string& condition) { std::fprintf(stderr, "%s\n", condition.c_str()); });
  if (!result) return report(result.error());
  result->width = arguments.width;
  result->height = height;
  if (Status written = write_study(*result, folder); !written) return report(written.error());
  std::filesystem::remove_all(scratch, ignored);
  say("{} has study.md, study.svg and study.json\n", folder.string());
  return kExitOk;
}

}  // namespace

void add_bench_verb(CLI::App& app, const OnSelected& on_selected) {
  CLI::App* bench = app.add_subcommand("bench", "measurements to repeat on your own machine");
  bench->require_subcommand(1);
  add_bench_error(*bench, on_selected);
  auto arguments = std::make_shared<DeterminismArguments>();
  CLI::App* verb = bench->add_subcommand(
      "determinism", "what changes Cycles' pixels: nine scenes in many conditions (minutes)");
  verb->add_option("-o,--output", arguments->output, "folder for the tables and the plot")
      ->type_name("DIR")
      ->capture_default_str();
  add_blender_option(*verb, arguments->blender);
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
