// seedframe explain: everything about one frame.

#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/campaign.h"
#include "cli/allow_option.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"
#include "plan/left_out.h"
#include "report/frame_explanation.h"

namespace seedframe {
namespace {

struct ExplainArguments {
  std::string folder;
  std::int64_t frame = 0;
  std::vector<std::string> allowed;
  bool json = false;
};

std::string render_again_command(const ExplainArguments& arguments) {
  return fmt::format("seedframe resume {} --frame {}", arguments.folder, arguments.frame);
}

void print_explanation(const FrameExplanation& explanation, const Campaign& campaign,
                       const ExplainArguments& arguments) {
  const FrameRow& row = explanation.row;
  fmt::print("frame {}: frame {} of scene {}, {}\n", row.frame, explanation.expanded.view,
             row.scene, to_string(row.state));
  fmt::print("frame id   {}\n", row.frame_id);
  if (explanation.expanded.id != row.frame_id) {
    fmt::print("           the config or its inputs have changed: today it would be {}\n",
               explanation.expanded.id);
  }
  if (!row.pixel_hash.empty()) fmt::print("pixel hash {}\n", row.pixel_hash);
  if (explanation.manifest) {
    for (const auto& [pass, hash] : explanation.manifest->pixel_hashes) {
      fmt::print("  {:<9}{}\n", pass, hash);
    }
    const Manifest& manifest = *explanation.manifest;
    if (manifest.pixel_hashes.contains("image")) {
      fmt::print("picture    {} ({})\n", manifest.image_file(), describe(manifest.image));
    }
    fmt::print("files      {}\n", campaign.files.frame(row.frame).string());
  }
  const FrameSpec& spec = explanation.expanded.spec;
  fmt::print("scene      {} instances, {} materials, {} lights; Cycles seed {}\n",
             spec.instances.size(), spec.materials.size(), spec.lights.size(), spec.render.seed);
  for (const LeftOut& each : left_out(spec)) {
    fmt::print("left out   {}: {}\n", each.what, each.why);
  }
  for (const AttemptRow& attempt : explanation.attempts) {
    const std::string maker = attempt.worker == kNoWorker
                                  ? "found on this machine"
                                  : fmt::format("worker {}", attempt.worker);
    fmt::print("attempt {}  {}, {}: build {:.3f} s, render {:.3f} s, finish {:.3f} s{}{}\n",
               attempt.attempt, maker, to_string(attempt.outcome), attempt.build_s,
               attempt.render_s, attempt.finish_s, attempt.message.empty() ? "" : "\n  ",
               attempt.message);
    const Json provenance = provenance_of(attempt);
    if (!provenance.contains("blender")) continue;
    const auto word = [&](const char* key) { return provenance.value(key, Json()).dump(); };
    fmt::print("  Blender {}, Cycles' kernel {}, Embree's {}, threads {}\n", word("blender"),
               word("kernel"), word("embree"), word("threads"));
  }
  fmt::print("draws\n");
  for (const Draw& draw : explanation.expanded.draws) {
    fmt::print("  {:<44} {}\n", draw.name, canonical_json(draw.value));
  }
  fmt::print("render it again: {}\n", render_again_command(arguments));
}

int explain(const ExplainArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<PreparedCampaign> prepared =
      prepare_again(*campaign, seedframe_home(), arguments.allowed);
  if (!prepared) return report(prepared.error());
  const Result<FrameExplanation> explanation = explain_frame(*campaign, *prepared, arguments.frame);
  if (!explanation) return report(explanation.error());
  if (arguments.json) {
    fmt::print("{}", readable_json(to_json(*explanation, render_again_command(arguments))));
  } else {
    print_explanation(*explanation, *campaign, arguments);
  }
  return kExitOk;
}

}  // namespace

void add_explain_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* verb = app.add_subcommand(
      "explain", "one frame: its draws, attempts, timings, hashes, and how to render it again");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("FRAME", arguments->frame, "index of the frame, from 0")
      ->required()
      ->check(CLI::NonNegativeNumber);
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer("Example: seedframe explain results/parts 12");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return explain(*arguments); }); });
}

}  // namespace seedframe
