// seedframe submit: a config to a rendered campaign.

#include <chrono>
#include <future>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "base/files.h"
#include "campaign/disk_space.h"
#include "campaign/input_images.h"
#include "campaign/run_setup.h"
#include "cli/replace_campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/choose_settings.h"
#include "console/executor_options.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/progress.h"
#include "console/run_campaign.h"
#include "console/run_options.h"
#include "console/say.h"
#include "console/temporary_folder.h"
#include "plan/frame_bytes.h"
#include "report/forecast.h"
#include "scene/expansion_summary.h"

namespace seedframe {
namespace {

struct SubmitArguments {
  std::string config;
  std::string output;
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  std::int64_t frames = 0;
  bool dry_run = false;
  bool overwrite = false;
  bool yes = false;
  int pilots = 0;  ///< frames to be made in a dry run
  RunOptions run;
  ExecutorOptions executor;
};

Result<PreparedCampaign> prepare_submission(const SubmitArguments& arguments) {
  Result<CampaignSource> source = read_source(arguments.config, arguments.set, seedframe_home(),
                                              with_own_assets(arguments.allowed));
  if (!source) return forward_error(source);
  return prepare(std::move(*source));
}

void print_plan(const PreparedCampaign& prepared, const ExpansionSummary& summary,
                const RunSetup& setup, std::int64_t frames, const std::filesystem::path& folder) {
  const CampaignSettings& settings = prepared.settings;
  const bool rendered = settings.labels == LabelSource::kIndexPass;
  say("{} scenes × {} frames: {} of {} frames would be {}, {} × {}{}\n", settings.scenes,
      settings.frames_per_scene, frames, settings.frame_count(), rendered ? "rendered" : "labelled",
      settings.render.width, settings.render.height,
      rendered ? fmt::format(" at {} samples", settings.render.samples) : std::string());
  say("seed {}, {} categories, {} meshes, {} images\n", settings.seed, settings.categories.size(),
      summary.meshes.size(), summary.used.images.size());
  say("{}", describe_constraints(prepared.expander, summary.constraints));
  if (rendered && summary.rendered_px < summary.image_px) {
    say("left out: {:.1f} % of the pixels (render.region)\n",
        100.0 - 100.0 * static_cast<double>(summary.rendered_px) /
                    static_cast<double>(summary.image_px));
  }
  if (settings.quality) {
    say("what each frame needs for {} of {} would be found out first, by {} small renderings "
        "or a few more\n",
        kQualityMetricNames[static_cast<std::size_t>(settings.quality->metric)],
        settings.quality->max_error, 2 * settings.frame_count());
  }
  say("by {}\n", describe(setup));
  say("into {} (nothing was written)\n", folder.string());
}

/// What it would take, told by frames that are made beside.
Result<Forecast> make_pilots(const PreparedCampaign& prepared, const RunSetup& setup,
                             std::int64_t frames, int pilots) {
  if (prepared.settings.quality) {
    return fail(ErrorKind::kInput,
                "--pilot: with a section 'quality' frames cost what is found out for each of them, "
                "which a dry run leaves out");
  }
  const Result<TemporaryFolder> scratch = TemporaryFolder::make("seedframe-pilot");
  if (!scratch) return forward_error(scratch);
  Progress progress(std::min<std::int64_t>(pilots, frames), 0, setup.options.quiet);
  Result<Forecast> told =
      forecast(prepared, setup, frames, pilots, scratch->path() / "campaign", progress);
  progress.finish();
  return told;
}

/// By frames of the campaign that is there already, if there is one with frames like these.
std::optional<Forecast> told_by_earlier_frames(const PreparedCampaign& prepared,
                                               const RunSetup& setup, std::int64_t frames,
                                               const std::filesystem::path& folder) {
  std::error_code missing;
  if (prepared.settings.quality ||
      !std::filesystem::exists(CampaignFiles(folder).store(), missing)) {
    return std::nullopt;
  }
  const Result<Campaign> campaign = open_campaign(folder);
  if (!campaign) return std::nullopt;
  const auto told = told_by(*campaign, prepared.settings, setup.options.pool.workers, frames);
  return told ? *told : std::nullopt;
}

/// `prepared_s`: seconds since the command began, which submitting would take too.
int tell_costs(const SubmitArguments& arguments, const PreparedCampaign& prepared,
               const RunSetup& setup, std::int64_t frames, const std::filesystem::path& folder,
               double prepared_s) {
  if (arguments.pilots > 0) {
    const Result<Forecast> told = make_pilots(prepared, setup, frames, arguments.pilots);
    if (!told) return report(told.error());
    say("about {} and {}, by {} frames that were made to tell ({:.3f} s each, ± {:.0f} %)\n",
        duration_text(prepared_s + told->wall_s), bytes_text(told->bytes), told->pilots,
        told->frame_s, 100.0 * told->spread);
    return kExitOk;
  }
  if (const auto told = told_by_earlier_frames(prepared, setup, frames, folder)) {
    say("about {} and {}, by {} frames of the campaign that is there ({:.3f} s each); --pilot 8 "
        "would make 8 frames to tell it by these\n",
        duration_text(prepared_s + told->wall_s), bytes_text(told->bytes), told->pilots,
        told->frame_s);
    return kExitOk;
  }
  say("about {}; --pilot 8 would make 8 frames to tell how long they take\n",
      bytes_text(typical_frame_bytes(prepared.settings) * static_cast<std::uint64_t>(frames)));
  return kExitOk;
}

int submit(const SubmitArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const auto executor = choose_executor(arguments.executor, nullptr);
  if (!executor) return report(executor.error());
  Result<PreparedCampaign> prepared = prepare_submission(arguments);
  if (!prepared) return report(prepared.error());
  const std::filesystem::path folder =
      arguments.output.empty() ? std::filesystem::path("results") / prepared->settings.name
                               : std::filesystem::path(arguments.output);
  const std::int64_t all = prepared->settings.frame_count();
  const std::int64_t wanted = arguments.frames > 0 ? std::min(arguments.frames, all) : all;
  if (Status good = check_input_images(*prepared, cache_folder()); !good) {
    return report(good.error());
  }
  // Every frame is expanded once before anything is written: a mistake in the last one leaves no
  // folder behind that somebody would have to take away again.
  // Meanwhile Blender, which may have to be started for that, is asked what it is.
  auto setting_up = std::async(
      std::launch::async, [&] { return set_up_run(arguments.run, prepared->settings, wanted); });
  const Result<ExpansionSummary> summary = expand_all(prepared->expander, {.id = false});
  Result<RunSetup> setup = setting_up.get();
  if (!summary) return report(summary.error());
  if (!setup) return report(setup.error());
  print_notes(*setup);
  if (arguments.dry_run) {
    if (*executor) say("by tasks of Slurm; what follows is told for this machine\n");
    print_plan(*prepared, *summary, *setup, wanted, folder);
    const std::chrono::duration<double> prepared_s = std::chrono::steady_clock::now() - begin;
    return tell_costs(arguments, *prepared, *setup, wanted, folder, prepared_s.count());
  }
  if (arguments.overwrite) {
    if (Status cleared = clear_for_new_campaign(folder, arguments.yes); !cleared) {
      return report(cleared.error());
    }
  }
  if (prepared->settings.quality) {
    if (Status possible = check_new_campaign(folder); !possible) return report(possible.error());
    if (Status chosen = choose_settings(*prepared, *setup); !chosen) return report(chosen.error());
  }
  Result<LockedCampaign> created = create_campaign(folder, *prepared);
  if (!created) return report(created.error());
  Campaign& campaign = created->campaign;
  if (Status begun = begin_run(campaign); !begun) return report(begun.error());
  if (Status kept = remember_executor(*executor, campaign.store); !kept) {
    return report(kept.error());
  }
  use_executor(*executor, arguments.run, *setup);
  std::vector<PendingFrame> pending;
  for (std::int64_t frame = 0; frame < wanted; ++frame) pending.push_back({frame});
  return run_campaign(campaign, *prepared, summary->used, *setup, std::move(pending));
}

}  // namespace

void add_submit_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<SubmitArguments>();
  CLI::App* verb =
      app.add_subcommand("submit", "validate, expand and render a campaign to the end");
  verb->add_option("CONFIG", arguments->config, "campaign config (docs/config.md)")->required();
  verb->add_option("-o,--output", arguments->output,
                   "folder of the campaign (default: results/<name of the campaign>)")
      ->type_name("DIR");
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  add_allow_option(*verb, arguments->allowed);
  verb->add_option("--frames", arguments->frames,
                   "render only the first N frames; 'resume' renders the rest")
      ->check(CLI::PositiveNumber);
  CLI::Option* dry_run = verb->add_flag("--dry-run", arguments->dry_run, "show what would be done");
  verb->add_option(
          "--pilot", arguments->pilots,
          "with --dry-run: make N frames, in a folder that goes again, and tell how long all "
          "would take")
      ->type_name("N")
      ->needs(dry_run)
      ->check(CLI::Range(1, 10'000));
  CLI::Option* overwrite = verb->add_flag("--overwrite", arguments->overwrite,
                                          "remove the campaign that is in the folder, after asking")
                               ->excludes(dry_run);
  verb->add_flag("--yes", arguments->yes, "with --overwrite: without asking")->needs(overwrite);
  add_run_options(*verb, arguments->run);
  add_executor_options(*verb, arguments->executor);
  verb->footer(
      "Example: seedframe submit configs/parts.yaml -o results/parts --set render.samples=16");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return submit(*arguments); }); });
}

}  // namespace seedframe
