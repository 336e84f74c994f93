// seedframe export: annotations of a rendered campaign.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "base/nearest_name.h"
#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "export/campaign_dataset.h"
#include "export/export_index.h"
#include "export/export_run.h"
#include "export/verify.h"
#include "formats/formats.h"
#include "manual/describe_command.h"

namespace seedframe {
namespace {

struct ExportArguments {
  std::string folder;
  std::string output;
  std::vector<std::string> formats;
  std::vector<std::string> allowed;
  std::string split;
  std::string polygon = "exact";
  std::string polygon_vertices = "edges";
  ExportOptions options;
  bool link = false;
  bool partial = false;
  bool verify = false;
};

/// "train=0.8,val=0.2" to shares, train first. One that is left out takes the rest.
Result<std::vector<SplitShare>> parse_splits(const std::string& text) {
  const std::vector<std::string> names = {"train", "val", "test"};
  std::vector<SplitShare> splits;
  if (text.empty()) return std::vector<SplitShare>{{"train", 1.0}};
  double sum = 0.0;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    char* end = nullptr;
    const double share =
        equals == std::string::npos ? NAN : std::strtod(part.c_str() + equals + 1, &end);
    const bool whole = end != nullptr && *end == '\0' && share >= 0.0;
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    const bool twice = std::any_of(splits.begin(), splits.end(),
                                   [&](const SplitShare& split) { return split.name == name; });
    if (!whole || !known || twice) {
      return fail(ErrorKind::kInput, "--split {}: expected train=0.8,val=0.2, found '{}'{}", text,
                  part, known ? "" : did_you_mean(name, names));
    }
    splits.push_back({name, share});
    sum += share;
  }
  const auto train = std::find_if(splits.begin(), splits.end(),
                                  [](const SplitShare& split) { return split.name == "train"; });
  if (train == splits.end()) {
    splits.insert(splits.begin(), {"train", 1.0 - sum});
  } else {
    std::rotate(splits.begin(), train, train + 1);
    if (splits.size() == 1 && sum < 1.0) splits.push_back({"val", 1.0 - sum});
  }
  // val before test, so that test can be added without moving what is in val.
  std::sort(splits.begin() + 1, splits.end(),
            [](const SplitShare& a, const SplitShare& b) { return a.name > b.name; });
  return splits;
}

Result<ExportOptions> options_of(const ExportArguments& arguments) {
  ExportOptions options = arguments.options;
  auto splits = parse_splits(arguments.split);
  if (!splits) return forward_error(splits);
  options.splits = std::move(*splits);
  options.output = arguments.output;
  options.link_images = arguments.link;
  options.polygon_detail =
      arguments.polygon == "simplified" ? PolygonDetail::kSimplified : PolygonDetail::kExact;
  options.polygon_vertices =
      arguments.polygon_vertices == "centres" ? PolygonVertices::kCentres : PolygonVertices::kEdges;
  if (options.workers == 0) {
    options.workers = core_count();
  }
  if (Status possible = check_export_options(options); !possible) return forward_error(possible);
  return options;
}

void print_summary(const ExportSummary& summary) {
  say("{}: {}\n", summary.format, summary.folder.string());
  for (const SplitSummary& split : summary.splits) {
    const auto count = [&](Count which) { return at(split.counts, which); };
    say("  {:<5} {} images ({} without annotations), {} annotations", split.split, split.images,
        split.background_images, count(Count::kAnnotations));
    for (const auto& [which, text] :
         {std::pair(Count::kTooSmall, "left out as too small"),
          std::pair(Count::kTooHidden, "left out as too hidden"),
          std::pair(Count::kDuplicateRows, "rows that loaders merge with another"),
          std::pair(Count::kLeftOutParts, "without fragments smaller than a bridge to them"),
          std::pair(Count::kOtherBoxes, "whose smallest rectangle leaves the image")}) {
      if (count(which) > 0) say(", {} {}", count(which), text);
    }
    say("\n");
  }
  if (summary.reused > 0) {
    say("  {} of {} frames are unchanged and were taken over\n", summary.reused, summary.frames);
  }
}

/// Each once, although several formats may have it.
void print_warnings(const std::vector<ExportSummary>& summaries) {
  std::set<std::string> told;
  for (const ExportSummary& summary : summaries) {
    for (const std::string& warning : summary.warnings) {
      if (!told.insert(warning).second) continue;
      say_aside("seedframe: note: {}\n", warning);
    }
  }
}

/// Each once, in the order of the first mention.
Result<std::vector<const FormatEntry*>> find_formats(const std::vector<std::string>& names) {
  std::vector<const FormatEntry*> formats;
  for (const std::string& name : names) {
    const auto format = find_format(export_formats(), name);
    if (!format) return forward_error(format);
    if (std::find(formats.begin(), formats.end(), *format) == formats.end()) {
      formats.push_back(*format);
    }
  }
  return formats;
}

/// Folders of exports in the output folder, of the named formats or of all that are there.
Result<std::vector<std::filesystem::path>> folders_to_verify(
    const std::vector<const FormatEntry*>& named, const std::filesystem::path& output) {
  std::vector<std::filesystem::path> folders;
  folders.reserve(export_formats().size());
  for (const FormatEntry* format : named) folders.push_back(output / format->name);
  if (!folders.empty()) return folders;
  for (const FormatEntry& format : export_formats()) {
    if (std::filesystem::exists(output / format.name / kMarkerFile)) {
      folders.push_back(output / format.name);
    }
  }
  if (folders.empty()) {
    return fail(ErrorKind::kInput, "{} holds no export of Seedframe", output.string());
  }
  return folders;
}

int verify_all(const Dataset& dataset, const std::vector<std::filesystem::path>& folders,
               int workers) {
  int code = kExitOk;
  for (const std::filesystem::path& folder : folders) {
    const Result<VerifySummary> summary = verify_export(dataset, export_formats(), folder, workers);
    if (!summary) return report(summary.error());
    say("{}: {} frames with {} annotations compared with their source, {}\n", summary->format,
        summary->frames, summary->annotations,
        summary->differences == 0 ? "all equal"
                                  : fmt::format("{} differences", summary->differences));
    for (const std::string& difference : summary->first_differences) {
      code = report({ErrorKind::kCorrupt, fmt::format("{}: {}", summary->format, difference)});
    }
  }
  return code;
}

int export_campaign(const ExportArguments& arguments) {
  const auto formats = find_formats(arguments.formats);
  if (!formats) return report(formats.error());
  if (formats->empty() && !arguments.verify) {
    return report({ErrorKind::kInput, "--format says what to write, such as --format coco"});
  }
  auto options = options_of(arguments);
  if (!options) return report(options.error());
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  if (options->output.empty()) options->output = campaign->files.exports();
  Result<KeptInputs> inputs = inputs_of(*campaign, seedframe_home(), arguments.allowed);
  if (!inputs) return report(inputs.error());
  const Result<CampaignDataset> dataset = campaign_dataset(*campaign, std::move(*inputs));
  if (!dataset) return report(dataset.error());
  if (arguments.verify) {
    const auto folders = folders_to_verify(*formats, options->output);
    if (!folders) return report(folders.error());
    return verify_all(dataset->dataset, *folders, options->workers);
  }
  if (dataset->missing > 0 && !arguments.partial) {
    return report({ErrorKind::kInput,
                   fmt::format("{} frames are not done: 'seedframe resume {}' renders them, or "
                               "--partial exports without them",
                               dataset->missing, campaign->files.root().string())});
  }
  const auto outcome = run_export(dataset->dataset, *formats, *options);
  if (!outcome) return report(outcome.error());
  for (const ExportSummary& summary : outcome->written) print_summary(summary);
  print_warnings(outcome->written);
  if (dataset->missing > 0) {
    std::fprintf(stderr, "seedframe: note: %lld frames are missing\n",
                 static_cast<long long>(dataset->missing));
  }
  for (const ImpossibleExport& each : outcome->impossible) {
    report({ErrorKind::kInput,
            fmt::format("{} was not written: {}", each.format, each.error.message)});
  }
  return outcome->impossible.empty() ? kExitOk : kExitSomeFailed;
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const FormatEntry& format : export_formats()) names.emplace_back(format.name);
  return names;
}

std::string list_of_formats() {
  std::string list = "annotation format, can be given more than once:";
  for (const FormatEntry& format : export_formats()) {
    list += fmt::format("\n  {}: {}", format.name, format.description);
  }
  return list;
}

}  // namespace

void add_export_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "write annotations of a rendered campaign");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  ExportOptions& options = arguments->options;
  options.workers = 0;
  verb->add_option("--format", arguments->formats, list_of_formats())
      ->allow_extra_args(false)
      ->type_name("FORMAT")
      ->check(offers(format_names()));
  verb->add_option("-o,--output", arguments->output,
                   "folder to write to (default: exports/ in the campaign's folder)")
      ->type_name("DIR");
  verb->add_option("--split", arguments->split,
                   "shares of the scenes, such as train=0.7,val=0.2,test=0.1 (default: all train)");
  verb->add_option("--min-pixels", options.min_pixels,
                   "leave out instances with fewer visible pixels")
      ->capture_default_str();
  verb->add_option("--min-visible", options.min_visible,
                   "leave out instances of which a smaller share is visible, 0 to 1")
      ->capture_default_str();
  verb->add_flag("--amodal", options.amodal, "masks and boxes of whole silhouettes");
  verb->add_option("--polygon", arguments->polygon,
                   "coco-polygon: exact, or simplified with an IoU of 0.99 or more")
      ->check(CLI::IsMember({"exact", "simplified"}))
      ->capture_default_str();
  verb->add_option("--polygon-vertices", arguments->polygon_vertices,
                   "yolo-segment: edges (for loaders that truncate) or centres (for loaders that "
                   "round)")
      ->check(CLI::IsMember({"edges", "centres"}))
      ->capture_default_str();
  verb->add_option("--patch-size", options.patch_size, "patches: pixels of a side; 0: as they are")
      ->capture_default_str();
  verb->add_option("--per-class", options.per_class,
                   "patches: exactly so many of every class, in all splits together")
      ->type_name("N")
      ->check(CLI::Range(1, 100'000'000));
  verb->add_option("--classes", options.patch_classes,
                   "patches: only of these classes (default: of all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("CLASS,…");
  verb->add_option("--min-side", options.min_side,
                   "patches: leave out those of which a side is shorter, in pixels of the image")
      ->capture_default_str();
  verb->add_option("--windows", options.windows,
                   "patches: of these classes windows that hold nothing but the class and those "
                   "named before it, such as field,line")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("CLASS,…");
  verb->add_option("--windows-per-frame", options.windows_per_frame,
                   "patches: windows of each such class in a frame")
      ->capture_default_str();
  verb->add_option("--shard-size", options.shard_size, "webdataset: samples in a tar")
      ->capture_default_str();
  verb->add_option("--workers", options.workers, "threads (default: one for each core)")
      ->check(CLI::Range(1, 256));
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--link", arguments->link, "hard-link the images instead of copying them");
  verb->add_flag("--partial", arguments->partial, "export although frames are missing");
  verb->add_flag("--verify", arguments->verify,
                 "write nothing: compare what is in the output folder with its source");
  verb->footer(
      "Example: seedframe export results/parts --format coco --format yolo-segment "
      "--split train=0.8,val=0.2");
  verb->callback([arguments, on_selected] {
    on_selected([arguments] { return export_campaign(*arguments); });
  });
}

}  // namespace seedframe
