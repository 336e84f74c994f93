// seedframe resume: exactly what is missing, failed or invalid.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/run_options.h"
#include "cli/verb.h"

namespace seedframe {
namespace {

struct ResumeArguments {
  std::string folder;
  std::vector<std::int64_t> frames;
  bool verify = false;
  RunArguments run;
};

/// Each frame that will be rendered must still be the frame that was submitted.
Status check_identities(const Campaign& campaign, PreparedCampaign& prepared,
                        const std::vector<PendingFrame>& frames) {
  for (const PendingFrame& pending : frames) {
    const Result<ExpandedFrame> expanded = prepared.expander.expand(pending.frame);
    if (!expanded) return forward_error(expanded);
    const auto row = campaign.store.frame(pending.frame);
    if (!row) return forward_error(row);
    if (!*row || (*row)->frame_id != expanded->id) {
      return fail(ErrorKind::kInput,
                  "{}: the config, an asset, a material or Seedframe itself changed since this "
                  "campaign was submitted: frame {} would be another image (id {} instead of {}). "
                  "Undo the change, or submit a new campaign",
                  campaign.files.root().string(), pending.frame, expanded->id.substr(0, 12),
                  *row ? (*row)->frame_id.substr(0, 12) : "none");
    }
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
    state.to_render.push_back({frame, (*row)->attempts});
  }
  return {};
}

int resume(ResumeArguments arguments) {
  Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<CampaignLock> lock = CampaignLock::acquire(campaign->files.lock());
  if (!lock) return report(lock.error());
  Result<CampaignSource> source = source_of(*campaign, seedframe_home());
  if (!source) return report(source.error());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  Result<Reconciliation> state =
      reconcile(*campaign, arguments.verify ? VerifyDepth::kContents : VerifyDepth::kSizes);
  if (!state) return report(state.error());
  for (const std::string& why : state->invalid) {
    std::fprintf(stderr, "to be rendered again: %s\n", why.c_str());
  }
  if (state->adopted > 0) {
    std::fprintf(stderr, "%lld frames were complete on disk already\n",
                 static_cast<long long>(state->adopted));
  }
  std::sort(arguments.frames.begin(), arguments.frames.end());
  if (Status selected = select_frames(*campaign, arguments.frames, *state); !selected) {
    return report(selected.error());
  }
  if (Status same = check_identities(*campaign, *prepared, state->to_render); !same) {
    return report(same.error());
  }
  Result<RunSetup> setup = set_up_run(arguments.run, prepared->config,
                                      static_cast<std::int64_t>(state->to_render.size()));
  if (!setup) return report(setup.error());
  return run_campaign(*campaign, *prepared, *setup, state->to_render, arguments.run);
}

}  // namespace

void add_resume_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ResumeArguments>();
  CLI::App* verb = app.add_subcommand(
      "resume",
      "render exactly what is missing, failed or invalid; a complete campaign renders nothing");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("--frame", arguments->frames, "render just this frame, even if it is done")
      ->allow_extra_args(false)
      ->check(CLI::NonNegativeNumber);
  verb->add_flag("--verify", arguments->verify,
                 "read every finished frame and compare it with its manifest, not only the sizes");
  add_run_options(*verb, arguments->run);
  verb->footer("Example: seedframe resume results/parts");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return resume(*arguments); }); });
}

}  // namespace seedframe
