// seedframe compare: two campaigns, frame by frame, by hash first.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "audit/campaign_comparison.h"
#include "base/message_text.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/say.h"
#include "console/tolerance_options.h"

namespace seedframe {
namespace {

using Kind = ComparedFrame::Kind;

struct CompareArguments {
  std::string first;
  std::string second;
  std::int64_t most_frames = 100;
  std::string heat_maps;
  Tolerance tolerance;
  bool json = false;
};

void print_frame(const ComparedFrame& frame) {
  say("frame {}: {}", frame.frame, to_string(frame.kind));
  if (frame.difference) {
    const std::string text = describe(*frame.difference);
    say(" ({})\n", to_string(frame.difference->grade));
    if (!text.empty()) say("  {}\n", text);
  } else {
    say("\n");
  }
  for (const std::string& line : frame.spec) say("  {}\n", printable(line));
  if (!frame.provenance.empty()) say("  made with {}\n", printable(frame.provenance));
}

void print_comparison(const CampaignComparison& comparison) {
  if (comparison.frames.empty() && !comparison.first_hash.empty()) {
    say("{} frames are identical: dataset hash {}\n", comparison.identical, comparison.first_hash);
    return;
  }
  constexpr std::size_t kMostShown = 20;
  for (std::size_t i = 0; i < std::min(kMostShown, comparison.frames.size()); ++i) {
    print_frame(comparison.frames[i]);
  }
  if (comparison.frames.size() > kMostShown) {
    say("and {} frames more: --json lists them\n", comparison.frames.size() - kMostShown);
  }
  say("{} frames are identical", comparison.identical);
  for (const Kind kind :
       {Kind::kOtherPixels, Kind::kOtherSpec, Kind::kOnlyInFirst, Kind::kOnlyInSecond}) {
    if (const auto count = comparison.count(kind); count > 0) {
      say(", {} {}", count, to_string(kind));
    }
  }
  say("\n");
}

/// A frame that one of them lacks, or that was not looked at, is not reproducible so far.
ExitCode exit_code_of(const CampaignComparison& comparison) {
  const bool all_seen =
      std::all_of(comparison.frames.begin(), comparison.frames.end(),
                  [](const ComparedFrame& frame) { return frame.difference.has_value(); });
  return all_seen ? exit_code(comparison.grade) : kExitNotReproducible;
}

int compare(const CompareArguments& arguments) {
  const Result<Campaign> first = open_campaign(arguments.first);
  if (!first) return report(first.error());
  const Result<Campaign> second = open_campaign(arguments.second);
  if (!second) return report(second.error());
  const Result<CampaignComparison> comparison = compare_campaigns(
      *first, *second, arguments.tolerance, arguments.most_frames, arguments.heat_maps);
  if (!comparison) return report(comparison.error());
  if (arguments.json) {
    fmt::print("{}", readable_json(to_json(*comparison)));
  } else {
    print_comparison(*comparison);
  }
  return exit_code_of(*comparison);
}

}  // namespace

void add_compare_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* verb = app.add_subcommand(
      "compare",
      "two campaigns, frame by frame: what differs, how much, and what it was made with");
  verb->add_option("A", arguments->first, "folder of a campaign")->required()->type_name("DIR");
  verb->add_option("B", arguments->second, "folder of another one")->required()->type_name("DIR");
  verb->add_option("--frames", arguments->most_frames,
                   "most differing frames whose pixels are looked at")
      ->check(NotNegative())
      ->capture_default_str();
  verb->add_option("--images", arguments->heat_maps,
                   "write a picture of each difference into this folder")
      ->type_name("DIR");
  add_tolerance_options(*verb, arguments->tolerance);
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer("Example: seedframe compare results/parts results/parts_again");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return compare(*arguments); }); });
}

}  // namespace seedframe
