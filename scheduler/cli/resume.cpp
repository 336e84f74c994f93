// seedframe resume: exactly what is missing, failed or invalid.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "campaign/input_files.h"
#include "campaign/input_images.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/executor_options.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/run_campaign.h"
#include "console/run_options.h"
#include "console/say.h"
#include "quality/raise.h"

namespace seedframe {
namespace {

struct ResumeArguments {
  std::string folder;
  std::vector<std::int64_t> frames;
  std::vector<std::string> allowed;
  std::vector<std::string> set;
  bool verify = false;
  bool raise = false;
  bool yes = false;
  RunOptions run;
  ExecutorOptions executor;
};

void print_added(const RenewedFrames& renewed) {
  if (renewed.added == 0) return;
  std::fprintf(stderr, "%lld frames are new\n", static_cast<long long>(renewed.added));
}

void print_renewed(const RenewedFrames& renewed) {
  if (renewed.frames == 0) return;
  say_aside("{} frames have become different ({} of them finished), because these have changed:\n",
            renewed.frames, renewed.finished);
  constexpr std::size_t kMostShown = 10;
  for (std::size_t i = 0; i < std::min(kMostShown, renewed.inputs.size()); ++i) {
    say_aside("  {}\n", renewed.inputs[i]);
  }
  if (renewed.inputs.size() > kMostShown) {
    std::fprintf(stderr, "  and %zu more\n", renewed.inputs.size() - kMostShown);
  }
}

/// Finished frames are somebody's work: a terminal is asked, anything else has to say --yes.
bool may_replace(const RenewedFrames& renewed, bool yes) {
  print_renewed(renewed);
  if (yes || ::isatty(STDIN_FILENO) == 0) return yes;
  std::fprintf(stderr, "Replace them? [y/N] ");
  const int answer = std::getchar();
  return answer == 'y' || answer == 'Y';
}

Status heal_store(Campaign& campaign, const PreparedCampaign& prepared) {
  const Result<HealedRows> healed = heal_rows(campaign, prepared);
  if (!healed) return forward_error(healed);
  for (const std::int64_t frame : healed->lost) {
    std::fprintf(stderr, "the store had lost frame %lld: it is known again\n",
                 static_cast<long long>(frame));
  }
  for (const std::int64_t frame : healed->wrong) {
    std::fprintf(stderr, "the store had a wrong id for frame %lld: it has the right one\n",
                 static_cast<long long>(frame));
  }
  return {};
}

/// With --frame: just these, even if they are done.
Status select_frames(Campaign& campaign, const std::vector<std::int64_t>& wanted,
                     Reconciliation& state) {
  if (wanted.empty()) return {};
  state.to_render.clear();
  for (const std::int64_t frame : wanted) {
    const auto row = campaign.store.frame(frame);
    if (!row) return forward_error(row);
    if (!*row) return fail(ErrorKind::kInput, "the campaign has no frame {}", frame);
    if (Status reset = campaign.store.reset(frame); !reset) return reset;
    state.to_render.push_back({frame, (*row)->attempts, 0});
  }
  return {};
}

void print_raises(const RaisePlan& plan, int most_samples) {
  const std::string bound =
      fmt::format("{} of {:.4g}", plan.promise.measure->key, plan.promise.max_error);
  for (const FrameError& each : plan.at_their_most) {
    std::fprintf(
        stderr,
        "frame %lld (%.3g) is beyond %s with all render.samples (%d): it cannot be raised\n",
        static_cast<long long>(each.frame), each.error, bound.c_str(), most_samples);
  }
  if (plan.raises.empty()) {
    std::fprintf(stderr, "no frame that was measured is beyond %s and can be raised\n",
                 bound.c_str());
    return;
  }
  std::fprintf(stderr, "%zu frames are beyond %s and are rendered again:\n", plan.raises.size(),
               bound.c_str());
  for (const Raise& raise : plan.raises) {
    std::fprintf(stderr, "  frame %lld (%.3g): %s instead of %s\n",
                 static_cast<long long>(raise.frame), raise.error, describe(raise.to).c_str(),
                 describe(raise.from).c_str());
  }
}

/// Which frames; none if nothing is to be raised.
Result<std::vector<std::int64_t>> raise_measured(Campaign& campaign, PreparedCampaign& prepared) {
  const Result<RaisePlan> plan = plan_raises(campaign, prepared);
  if (!plan) return forward_error(plan);
  print_raises(*plan, prepared.settings.render.samples);
  std::vector<std::int64_t> frames;
  for (const Raise& raise : plan->raises) frames.push_back(raise.frame);
  if (frames.empty()) return frames;
  if (Status raised = raise_frames(campaign, prepared, *plan); !raised) {
    return forward_error(raised);
  }
  return frames;
}

/// A run on this machine makes the frames that tasks of Slurm may still be making.
void tell_of_tasks(const CampaignFiles& files) {
  std::error_code missing;
  if (!std::filesystem::exists(files.slurm(), missing)) return;
  say_aside(
      "seedframe: note: tasks of Slurm may be at work for {0}, and this run does not wait for "
      "them: "
      "'scancel --name={1}' ends them, --executor slurm would go on with them\n",
      files.root().string(), files.root().filename().string());
}

int resume(ResumeArguments arguments) {
  Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<FolderLock> lock = FolderLock::acquire(campaign->files.lock());
  if (!lock) return report(lock.error());
  const Result<std::vector<Override>> set = read_overrides(arguments.set);
  if (!set) return report(set.error());
  Result<PreparedCampaign> prepared =
      prepare_again(*campaign, seedframe_home(), arguments.allowed, *set);
  if (!prepared) return report(prepared.error());
  if (arguments.verify) {
    if (Status whole = campaign->store.check_integrity(); !whole) return report(whole.error());
  }
  if (Status begun = begin_run(*campaign); !begun) return report(begun.error());
  if (Status good = check_changed_images(*campaign, *prepared, cache_folder()); !good) {
    return report(good.error());
  }
  const Result<RenewedFrames> renewed = renew_changed_frames(
      *campaign, *prepared,
      [&](const RenewedFrames& changes) { return may_replace(changes, arguments.yes); });
  if (!renewed) return report(renewed.error());
  if (renewed->finished == 0) print_renewed(*renewed);
  print_added(*renewed);
  if (arguments.verify) {
    if (Status healed = heal_store(*campaign, *prepared); !healed) return report(healed.error());
  }
  std::vector<std::int64_t> raised;
  if (arguments.raise) {
    Result<std::vector<std::int64_t>> frames = raise_measured(*campaign, *prepared);
    if (!frames) return report(frames.error());
    raised = std::move(*frames);
  }
  Result<Reconciliation> state = reconcile(*campaign, arguments.verify);
  if (!state) return report(state.error());
  for (const std::string& why : state->invalid) {
    say_aside("to be rendered again: {}\n", why);
  }
  if (state->adopted > 0) {
    std::fprintf(stderr, "%lld frames were complete on disk already\n",
                 static_cast<long long>(state->adopted));
  }
  std::sort(arguments.frames.begin(), arguments.frames.end());
  if (Status selected = select_frames(*campaign, arguments.frames, *state); !selected) {
    return report(selected.error());
  }
  Result<RunSetup> setup = set_up_run(arguments.run, prepared->settings,
                                      static_cast<std::int64_t>(state->to_render.size()));
  if (!setup) return report(setup.error());
  print_notes(*setup);
  if (!arguments.frames.empty()) setup->options.no_cache = true;  // "render", it says
  const auto executor = choose_executor(arguments.executor, &campaign->store);
  if (!executor) return report(executor.error());
  if (Status kept = remember_executor(*executor, campaign->store); !kept) {
    return report(kept.error());
  }
  use_executor(*executor, arguments.run, *setup);
  if (!*executor) tell_of_tasks(campaign->files);
  const int code =
      run_campaign(*campaign, *prepared, renewed->used, *setup, std::move(state->to_render));
  if (!raised.empty()) {
    say("whether it was enough: 'seedframe verify-error {} --frame {}'\n", arguments.folder,
        fmt::join(raised, " --frame "));
  }
  return code;
}

}  // namespace

void add_resume_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ResumeArguments>();
  CLI::App* verb = app.add_subcommand(
      "resume",
      "render exactly what is missing, failed, invalid or out of date; a complete campaign renders "
      "nothing");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  CLI::Option* frame =
      verb->add_option("--frame", arguments->frames, "render just this frame, even if it is done")
          ->allow_extra_args(false)
          ->check(NotNegative());
  verb->add_flag(
          "--raise", arguments->raise,
          "give frames more samples that 'verify-error' found beyond the promised error, and "
          "render them again")
      ->excludes(frame);
  verb->add_option("--set", arguments->set,
                   "path=value: replaces a value of the config from now on; scenes=200 adds frames")
      ->allow_extra_args(false);
  verb->add_flag("--yes", arguments->yes,
                 "replace finished frames that would come out differently, without asking");
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag(
      "--verify", arguments->verify,
      "read every finished frame and compare it with its manifest, however untouched it looks, "
      "and check the store: its file, and that every frame has the row that it should have");
  add_run_options(*verb, arguments->run);
  add_executor_options(*verb, arguments->executor);
  verb->footer("Example: seedframe resume results/parts");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return resume(*arguments); }); });
}

}  // namespace seedframe
