// seedframe export: annotations of a rendered campaign.

#include <cmath>
#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "campaign/campaign.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"
#include "export/exporter.h"

namespace seedframe {
namespace {

struct ExportArguments {
  std::string folder;
  std::string output;
  std::vector<std::string> formats;
  std::string split;
  std::string polygon_vertices = "edges";
  int min_pixels = 1;
  bool link = false;
  bool partial = false;
};

/// "train=0.8,val=0.2" to 0.2.
Result<double> parse_val_share(const std::string& text) {
  if (text.empty()) return 0.0;
  double train = NAN;
  double val = NAN;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    char* end = nullptr;
    const double share =
        equals == std::string::npos ? NAN : std::strtod(part.c_str() + equals + 1, &end);
    const bool whole = end != nullptr && *end == '\0' && share >= 0.0;
    if (!whole || (name != "train" && name != "val")) {
      return fail(ErrorKind::kInput, "--split {}: expected train=0.8,val=0.2, found '{}'{}", text,
                  part, did_you_mean(name, {"train", "val"}));
    }
    (name == "train" ? train : val) = share;
  }
  if (std::isnan(val)) val = 1.0 - train;
  if (std::isnan(train)) train = 1.0 - val;
  constexpr double kRounding = 1e-9;
  if (std::abs(train + val - 1.0) > kRounding || train <= 0.0) {
    return fail(ErrorKind::kInput,
                "--split {}: the shares must add up to 1, and train must have some", text);
  }
  return val;
}

Result<Dataset> read_dataset(const Campaign& campaign, const PreparedCampaign& prepared,
                             bool partial) {
  Dataset dataset;
  dataset.name = prepared.config.name;
  dataset.categories = prepared.config.categories;
  dataset.has_images = prepared.config.labels.source == LabelSource::kIndexPass;
  std::int64_t missing = 0;
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    if (row.state != FrameState::kDone) {
      ++missing;
      return {};
    }
    const std::filesystem::path folder = campaign.files.frame(row.frame);
    const auto verified = verify_frame(folder, row.frame_id, VerifyDepth::kContents);
    if (!verified) {
      return fail(ErrorKind::kCorrupt, "{}\n'seedframe resume {} --verify' renders it again",
                  verified.error().message, campaign.files.root().string());
    }
    dataset.frames.push_back({row.frame, static_cast<int>(row.scene), folder, row.frame_id});
    return {};
  });
  if (!visited) return forward_error(visited);
  if (missing > 0 && !partial) {
    return fail(ErrorKind::kInput,
                "{} of {} frames are not done: 'seedframe resume {}' renders them, or --partial "
                "exports without them",
                missing, missing + static_cast<std::int64_t>(dataset.frames.size()),
                campaign.files.root().string());
  }
  if (missing > 0) {
    std::fprintf(stderr, "seedframe: note: %lld frames are missing\n",
                 static_cast<long long>(missing));
  }
  return dataset;
}

void print_summary(const ExportFormat& format, const ExportSummary& summary) {
  fmt::print("{}: {}\n", format.name, summary.folder.string());
  for (const SplitSummary& split : summary.splits) {
    fmt::print("  {:<5} {} images ({} without objects), {} annotations", split.split, split.images,
               split.background_images, split.annotations);
    if (split.skipped_small > 0) fmt::print(", {} left out as too small", split.skipped_small);
    if (split.duplicate_rows > 0) {
      fmt::print(", {} rows that loaders merge with another", split.duplicate_rows);
    }
    fmt::print("\n");
  }
  for (const std::string& warning : summary.warnings) {
    std::fprintf(stderr, "seedframe: note: %s\n", warning.c_str());
  }
}

Result<std::vector<const ExportFormat*>> find_formats(const std::vector<std::string>& names) {
  std::vector<const ExportFormat*> formats;
  for (const std::string& name : names) {
    const auto format = find_export_format(name);
    if (!format) return forward_error(format);
    formats.push_back(*format);
  }
  return formats;
}

int export_campaign(const ExportArguments& arguments) {
  const auto formats = find_formats(arguments.formats);
  if (!formats) return report(formats.error());
  const Result<double> val_share = parse_val_share(arguments.split);
  if (!val_share) return report(val_share.error());
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  Result<CampaignSource> source = source_of(*campaign, seedframe_home());
  if (!source) return report(source.error());
  const Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  const Result<Dataset> dataset = read_dataset(*campaign, *prepared, arguments.partial);
  if (!dataset) return report(dataset.error());
  ExportOptions options;
  options.output = arguments.output.empty() ? campaign->files.exports()
                                            : std::filesystem::path(arguments.output);
  options.min_pixels = arguments.min_pixels;
  options.link_images = arguments.link;
  options.val_share = *val_share;
  options.seed = prepared->config.seed;
  options.polygon_vertices =
      arguments.polygon_vertices == "centres" ? PolygonVertices::kCentres : PolygonVertices::kEdges;
  for (const ExportFormat* format : *formats) {
    const Result<ExportSummary> summary = format->run(*dataset, options);
    if (!summary) return report(summary.error());
    print_summary(*format, *summary);
  }
  return kExitOk;
}

std::string list_of_formats() {
  std::string list = "annotation format, can be given more than once:";
  for (const ExportFormat& format : export_formats()) {
    list += fmt::format("\n  {}: {}", format.name, format.description);
  }
  return list;
}

}  // namespace

void add_export_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "write annotations of a rendered campaign");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("--format", arguments->formats, list_of_formats())
      ->required()
      ->allow_extra_args(false);
  verb->add_option("-o,--output", arguments->output,
                   "folder to write to (default: exports/ in the campaign's folder)");
  verb->add_option("--split", arguments->split,
                   "shares of the scenes, such as train=0.8,val=0.2 (default: all train)");
  verb->add_option("--min-pixels", arguments->min_pixels,
                   "leave out instances with fewer visible pixels")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--polygon-vertices", arguments->polygon_vertices,
                   "YOLO: edges (for loaders that truncate) or centres (for loaders that round)")
      ->check(CLI::IsMember({"edges", "centres"}))
      ->capture_default_str();
  verb->add_flag("--link", arguments->link, "hard-link the images instead of copying them");
  verb->add_flag("--partial", arguments->partial, "export although frames are missing");
  verb->footer(
      "Example: seedframe export results/parts --format coco --format yolo-segment "
      "--split train=0.8,val=0.2");
  verb->callback([arguments, on_selected] {
    on_selected([arguments] { return export_campaign(*arguments); });
  });
}

}  // namespace seedframe
