#include "cli/bench_error.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "base/files.h"
#include "console/arguments.h"
#include "console/blender_option.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/run_options.h"
#include "console/say.h"
#include "quality/error_report.h"

namespace seedframe {
namespace {

struct ErrorArguments {
  std::vector<std::string> configs;
  std::string output = "results/error_vs_time";
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  int width = 0;
  ErrorStudyWishes wishes;
  RunOptions run;
};

/// The config at the width that is wished for, its shape kept.
Result<PreparedCampaign> prepare_scene(const ErrorArguments& arguments, const std::string& config) {
  Result<CampaignSource> source =
      read_source(config, arguments.set, seedframe_home(), with_own_assets(arguments.allowed));
  if (!source) return forward_error(source);
  Result<PreparedCampaign> prepared = prepare(*source);
  if (!prepared || arguments.width == 0) return prepared;
  const RenderSettings& render = prepared->settings.render;
  const int height =
      std::max(1, (render.height * arguments.width + render.width / 2) / render.width);
  source->overrides.push_back({"render.width", std::to_string(arguments.width)});
  source->overrides.push_back({"render.height", std::to_string(height)});
  return prepare(std::move(*source));
}

Result<SceneStudy> study_scene(const ErrorArguments& arguments, const std::string& config,
                               std::string& blender) {
  const Result<PreparedCampaign> prepared = prepare_scene(arguments, config);
  if (!prepared) return forward_error(prepared);
  // One worker with all cores: after a first round it has seen every mesh and image, so that what a
  // variation takes is its own.
  RunOptions options = arguments.run;
  options.pool.workers = 1;
  if (options.worker.threads == 0) options.worker.threads = core_count();
  options.no_cache = true;
  const Result<RunSetup> setup = set_up_run(options, prepared->settings, arguments.wishes.frames);
  if (!setup) return forward_error(setup);
  print_notes(*setup);
  blender = setup->blender.version;
  ErrorStudyWishes wishes = arguments.wishes;
  wishes.budget_s /= static_cast<double>(arguments.configs.size());
  std::error_code ignored;
  const auto scratch = std::filesystem::absolute(arguments.output, ignored) / "work";
  std::string last;
  Result<SceneStudy> study = study_errors(
      *prepared, *setup, scratch, wishes, [&](const std::string& variation, std::int64_t) {
        if (!arguments.run.quiet && variation != last) {
          say_aside("{}: {}\n", prepared->settings.name, variation);
        }
        last = variation;
      });
  std::filesystem::remove_all(scratch, ignored);
  return study;
}

int bench_error(const ErrorArguments& arguments) {
  ErrorReport result;
  std::string blender;
  for (const std::string& config : arguments.configs) {
    Result<SceneStudy> study = study_scene(arguments, config, blender);
    if (!study) return report(study.error());
    result.scenes.push_back(std::move(*study));
  }
  result.made_with =
      fmt::format("seedframe {}, Blender {}, {} cores", SEEDFRAME_VERSION, blender, core_count());
  if (Status written = write_error_report(result, arguments.output); !written) {
    return report(written.error());
  }
  say("{} has error.md, error.csv, error.json and charts\n", arguments.output);
  return kExitOk;
}

}  // namespace

void add_bench_error(CLI::App& bench, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ErrorArguments>();
  CLI::App* verb = bench.add_subcommand(
      "error", "run time against error: what samples, denoising and other settings buy");
  verb->add_option("CONFIG", arguments->configs, "campaign configs whose frames are tried")
      ->required();
  verb->add_option("-o,--output", arguments->output, "folder for tables and charts")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the configs")
      ->allow_extra_args(false);
  verb->add_option("--frames", arguments->wishes.frames, "frames to try of each config")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--budget", arguments->wishes.budget_s,
                   "time for all configs together, as 90s, 10min or 2h; what does not fit is left "
                   "out (default: 10min)")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, double>{{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}}))
      ->type_name("TIME");
  verb->add_option("--width", arguments->width,
                   "pixels; the height follows (default: the config's own)")
      ->check(CLI::Range(16, 16384));
  verb->add_option("--most-samples", arguments->wishes.most_samples, "of a pixel")
      ->check(CLI::Range(16, 65536))
      ->capture_default_str();
  verb->add_option("--reference-samples", arguments->wishes.reference_samples,
                   "of what all is compared with; fewer if they take over half of the budget")
      ->check(CLI::Range(64, 1 << 20))
      ->capture_default_str();
  verb->add_option("--threads", arguments->run.worker.threads, "of Blender (default: all cores)")
      ->check(CLI::Range(1, 1024));
  add_blender_option(*verb, arguments->run.blender);
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--quiet", arguments->run.quiet, "no progress");
  verb->footer(
      "Example: seedframe bench error configs/parts.yaml -o results/error --width 160 --budget "
      "5min");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return bench_error(*arguments); }); });
}

}  // namespace seedframe
