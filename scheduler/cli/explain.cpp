// seedframe explain: everything about one frame.

#include <algorithm>
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "export/kept_inputs.h"
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

/// A table; positions are of the objects' origins.
void print_objects(const std::vector<ExplainedObject>& objects) {
  std::size_t name = 6, asset = 5, category = 8;
  for (const ExplainedObject& object : objects) {
    name = std::max(name, object.name.size());
    asset = std::max(asset, object.asset.size());
    category = std::max(category, object.category.size());
  }
  say("{:>5} {:<{}} {:<{}} {:<{}} {:>8} {:>8} {:>8} {:>8} {:>9} {:>7}\n", "id", "object", name,
      "asset", asset, "category", category, "x, m", "y", "z", "far, m", "pixels", "visible");
  const auto millimetres = [](double x) { return std::round(1e3 * x) / 1e3 + 0.0; };  // no -0.000
  for (const ExplainedObject& object : objects) {
    say("{:>5} {:<{}} {:<{}} {:<{}} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>9} {:>7}\n", object.id,
        object.name, name, object.asset, asset, object.category.empty() ? "-" : object.category,
        category, millimetres(object.position.x()), millimetres(object.position.y()),
        millimetres(object.position.z()), object.distance_m,
        object.visible_px ? std::to_string(*object.visible_px) : "?",
        object.visible_share ? fmt::format("{:.0f} %", 100 * *object.visible_share) : "?");
  }
}

void print_explanation(const FrameExplanation& explanation, const Campaign& campaign,
                       const std::vector<std::string>& categories,
                       const ExplainArguments& arguments) {
  const FrameRow& row = explanation.row;
  say("frame {}: frame {} of scene {}, {}\n", row.frame, explanation.expanded.view, row.scene,
      to_string(row.state));
  say("frame id   {}\n", row.frame_id);
  if (explanation.expanded.id != row.frame_id) {
    say("           the config or its inputs have changed: today it would be {}\n",
        explanation.expanded.id);
  }
  if (!row.pixel_hash.empty()) say("pixel hash {}\n", row.pixel_hash);
  if (explanation.manifest) {
    for (const auto& [pass, hash] : explanation.manifest->pixel_hashes) {
      say("  {:<9}{}\n", pass, hash);
    }
    const Manifest& manifest = *explanation.manifest;
    if (manifest.pixel_hashes.contains("image")) {
      say("picture    {} ({})\n", manifest.image_file(), describe(manifest.image));
    }
    say("files      {}\n", campaign.files.frame(row.frame).string());
  }
  const FrameSpec& spec = explanation.expanded.spec;
  say("scene      {} instances, {} materials, {} lights; Cycles seed {}\n", spec.instances.size(),
      spec.materials.size(), spec.lights.size(), spec.render.seed);
  for (const LeftOut& each : left_out(spec)) {
    say("left out   {}: {}\n", each.what, each.why);
  }
  for (const AttemptRow& attempt : explanation.attempts) {
    const std::string maker = attempt.worker == kNoWorker
                                  ? "found on this machine"
                                  : fmt::format("worker {}", attempt.worker);
    say("attempt {}  {}, {}: build {:.3f} s, render {:.3f} s, finish {:.3f} s{}{}\n",
        attempt.attempt, maker, to_string(attempt.outcome), attempt.build_s, attempt.render_s,
        attempt.finish_s, attempt.message.empty() ? "" : "\n  ", attempt.message);
    const Json provenance = provenance_of(attempt);
    if (!provenance.contains("blender")) continue;
    const auto word = [&](const char* key) { return provenance.value(key, Json()).dump(); };
    say("  Blender {}, Cycles' kernel {}, Embree's {}, threads {}\n", word("blender"),
        word("kernel"), word("embree"), word("threads"));
  }
  print_objects(explained_objects(explanation, categories));
  if (!explanation.alone) say("draws\n");
  for (const Draw& draw : explanation.expanded.draws) {
    say("  {:<44} {}\n", draw.name, canonical_json(draw.value));
  }
  say("render it again: {}\n", render_again_command(arguments));
}

void tell(const FrameExplanation& explanation, const Campaign& campaign,
          const std::vector<std::string>& categories, const ExplainArguments& arguments) {
  if (arguments.json) {
    fmt::print("{}",
               readable_json(to_json(explanation, categories, render_again_command(arguments))));
  } else {
    print_explanation(explanation, campaign, categories, arguments);
  }
}

/// As the campaign's own files have it, where its config's are not.
int explain_alone(const Campaign& campaign, const Error& why, const ExplainArguments& arguments) {
  const Result<std::optional<KeptInputs>> kept = read_kept_inputs(campaign.files);
  if (why.kind != ErrorKind::kInput || !kept || !*kept) return report(why);
  const Result<FrameExplanation> explanation = explain_frame_alone(campaign, arguments.frame);
  if (!explanation) return report(why);
  std::fprintf(
      stderr,
      "seedframe: note: the config cannot be read here, so draws are left out, and positions "
      "are seen from the camera:\n%s\n",
      printable(why.message).c_str());
  tell(*explanation, campaign, (*kept)->categories, arguments);
  return kExitOk;
}

int explain(const ExplainArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<PreparedCampaign> prepared =
      prepare_again(*campaign, seedframe_home(), arguments.allowed);
  if (!prepared) return explain_alone(*campaign, prepared.error(), arguments);
  const Result<FrameExplanation> explanation = explain_frame(*campaign, *prepared, arguments.frame);
  if (!explanation) return report(explanation.error());
  tell(*explanation, *campaign, prepared->settings.categories, arguments);
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
      ->check(NotNegative());
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer("Example: seedframe explain results/parts 12");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return explain(*arguments); }); });
}

}  // namespace seedframe
