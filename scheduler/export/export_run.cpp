#include "export/export_run.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>

#include "export/format_export.h"
#include "export/frame_pipeline.h"
#include "export/split.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kMostErrorsTold = 10;

/// A frame on its way.
struct FrameTask {
  CommittedFrame frame;
  int split = 0;
  std::int64_t ordinal = 0;                                 ///< among the frames of its split
  std::vector<std::optional<EarlierExport::Part>> earlier;  ///< by format
  // After it was made:
  Status status;
  std::vector<FrameRecord> records;
  std::vector<std::optional<Error>> refusals;  ///< of formats that cannot hold the frame
  std::vector<bool> reused;
  std::vector<IndexEntry> entries;
};

class ExportRun {
 public:
  ExportRun(const Dataset& dataset, const ExportOptions& options, std::deque<FormatExport>& exports)
      : dataset_(dataset), options_(options), exports_(exports), cursor_(dataset.frames()) {
    ordinals_.resize(options.splits.size(), 0);
    for (const FormatExport& each : exports) {
      const FrameParts needs = each.format().needs();
      parts_.image_file = parts_.image_file || needs.image_file;
      parts_.image_pixels = parts_.image_pixels || needs.image_pixels;
      parts_.depth = parts_.depth || needs.depth;
    }
  }

  Status run() {
    run_frame_pipeline<FrameTask>(
        options_.workers, [this] { return next(); }, [this](FrameTask& task) { make(task); },
        [this](FrameTask& task) { take(task); });
    return verdict();
  }

 private:
  /// The next frame; none at the end, or when nothing more can be made of it.
  std::shared_ptr<FrameTask> next() {
    if (hopeless_ || all_given_up()) return nullptr;
    auto frame = cursor_();
    if (!frame) {
      add_error(frame.error());
      return nullptr;
    }
    if (!*frame) return nullptr;
    auto task = std::make_shared<FrameTask>();
    task->frame = std::move(**frame);
    if (task->frame.index <= last_index_) {
      add_error({ErrorKind::kCorrupt, fmt::format("frame {} follows frame {}: each index must be "
                                                  "larger",
                                                  task->frame.index, last_index_)});
      return nullptr;
    }
    last_index_ = task->frame.index;
    task->split = split_of_scene(task->frame.scene, dataset_.seed, options_.splits);
    task->ordinal = ordinals_[static_cast<std::size_t>(task->split)]++;
    task->earlier.reserve(exports_.size());
    for (FormatExport& each : exports_) {
      task->earlier.push_back(each.take_earlier(task->frame.index));
    }
    return task;
  }

  void make(FrameTask& task) {
    try {
      task.status = make_records(task);
    } catch (const std::bad_alloc&) {
      task.status =
          fail(ErrorKind::kEnvironment, "frame {}: there is not enough memory", task.frame.index);
    }
  }

  Status make_records(FrameTask& task) {
    const auto files = FrameReader::open(task.frame, parts_);
    if (!files) return forward_error(files);
    if (broken_) return {};  // only to find out what else is wrong
    const std::size_t formats = exports_.size();
    task.records.resize(formats);
    task.refusals.resize(formats);
    task.reused.resize(formats, false);
    task.entries.resize(formats);
    std::unique_ptr<ExportFrame> selected;
    for (std::size_t i = 0; i < formats; ++i) {
      if (exports_[i].refusal() != nullptr) continue;
      const auto& earlier = task.earlier[i];
      task.reused[i] = earlier && exports_[i].reuse(*earlier, *files, task.records[i]);
      if (!task.reused[i]) {
        if (!selected) {
          auto loaded = load(*files, task);
          if (!loaded) return forward_error(loaded);
          selected = std::move(*loaded);
        }
        auto record = exports_[i].format().encode(*selected);
        if (!record && record.error().kind == ErrorKind::kInput) {
          task.refusals[i] = record.error();
          continue;
        }
        if (!record) return forward_error(record);
        task.records[i] = std::move(*record);
      }
      IndexEntry& entry = task.entries[i];
      entry.frame = task.frame.index;
      entry.key = files->key();
      entry.split = task.split;
      Status written = exports_[i].write_files(task.records[i], task.reused[i], entry);
      if (!written) return written;
    }
    return {};
  }

  Result<std::unique_ptr<ExportFrame>> load(const FrameReader& files, const FrameTask& task) const {
    auto loaded = files.load(dataset_.categories);
    if (!loaded) return forward_error(loaded);
    return select_instances(task.frame, std::move(*loaded),
                            options_.splits[static_cast<std::size_t>(task.split)].name, options_);
  }

  void take(FrameTask& task) {
    if (!task.status) {
      add_error(task.status.error());
      return;
    }
    if (broken_) return;
    for (std::size_t i = 0; i < exports_.size(); ++i) {
      if (exports_[i].refusal() != nullptr) continue;
      if (task.refusals[i]) {
        exports_[i].give_up(std::move(*task.refusals[i]));
        continue;
      }
      const Status appended = exports_[i].append(task.frame, task.ordinal, task.records[i],
                                                 task.reused[i], std::move(task.entries[i]));
      if (!appended) {
        add_error(appended.error());
        return;
      }
    }
  }

  /// What is wrong with a frame does not end the search for others; a full disk does.
  void add_error(const Error& error) {
    const std::lock_guard lock(errors_mutex_);  // the cursor may fail while frames are taken
    broken_ = true;
    if (error.kind != ErrorKind::kCorrupt) hopeless_ = true;
    if (++errors_ == 1) first_ = error;
    if (errors_ > kMostErrorsTold || hopeless_) return;
    told_ += (told_.empty() ? "" : "\n") + error.message;
  }

  bool all_given_up() const {
    return std::all_of(exports_.begin(), exports_.end(),
                       [](const FormatExport& each) { return each.refusal() != nullptr; });
  }

  Status verdict() {
    if (errors_ == 0) {
      if (all_given_up()) return {};
      if (last_index_ < 0) {
        return fail(ErrorKind::kInput,
                    "campaign '{}' has no complete frame to export: run 'seedframe resume' first",
                    dataset_.name);
      }
      if (ordinals_.front() > 0) return {};
      return fail(ErrorKind::kInput,
                  "with these shares and seed {} no scene is left to train on: give train a larger "
                  "share, or render more scenes",
                  dataset_.seed);
    }
    if (hopeless_) return tl::unexpected(first_);
    if (errors_ > kMostErrorsTold) {
      told_ += fmt::format("\n… and {} more frames", errors_ - kMostErrorsTold);
    }
    return fail(ErrorKind::kCorrupt, "{}", told_);
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  std::deque<FormatExport>& exports_;
  FrameCursor cursor_;
  FrameParts parts_;
  std::vector<std::int64_t> ordinals_;  ///< by split
  std::int64_t last_index_ = -1;
  std::atomic<bool> broken_ = false;
  std::atomic<bool> hopeless_ = false;
  std::mutex errors_mutex_;  ///< guards what follows while the frames are under way
  std::int64_t errors_ = 0;
  Error first_;
  std::string told_;
};

Status check_categories(const Dataset& dataset) {
  if (dataset.categories.empty()) {
    return fail(ErrorKind::kInput, "campaign '{}' has no categories: there is nothing to annotate",
                dataset.name);
  }
  for (const std::string& category : dataset.categories) {
    try {
      static_cast<void>(Json(category).dump());
    } catch (const Json::exception&) {
      return fail(ErrorKind::kInput, "a category's name is not valid UTF-8; rename it");
    }
  }
  return {};
}

/// Adds an export to `exports`, unless the format cannot hold the dataset.
Status begin_export(const Dataset& dataset, const FormatEntry& entry, const ExportOptions& options,
                    std::deque<FormatExport>& exports) {
  auto format = entry.make(dataset, options);
  if (!format) return forward_error(format);
  auto folder = ExportFolder::create(options.output, entry.name);
  if (!folder) return forward_error(folder);
  exports.emplace_back(entry, std::move(*format), std::move(*folder), options);
  return exports.back().begin(dataset);
}

/// With a single format its own error, else a line for each.
tl::unexpected<Error> none_possible(const std::vector<ImpossibleExport>& impossible) {
  if (impossible.size() == 1) return tl::unexpected(impossible.front().error);
  std::string lines;
  for (const ImpossibleExport& each : impossible) {
    lines += fmt::format("{}{}: {}", lines.empty() ? "" : "\n", each.format, each.error.message);
  }
  return fail(ErrorKind::kInput, "{}", lines);
}

void add_warnings(const Dataset& dataset, ExportSummary& summary) {
  if (!dataset.has_images) {
    summary.warnings.emplace_back(
        "the campaign has labels only (labels: geometry): no images were written");
  }
  for (const SplitSummary& split : summary.splits) {
    if (split.images > 0) continue;
    summary.warnings.push_back(
        fmt::format("no scene fell into {} (seed {})", split.split, dataset.seed));
  }
}

}  // namespace

Result<ExportOutcome> run_export(const Dataset& dataset,
                                 const std::vector<const FormatEntry*>& formats,
                                 const ExportOptions& options) {
  if (Status possible = check_export_options(options); !possible) return forward_error(possible);
  if (Status named = check_categories(dataset); !named) return forward_error(named);
  ExportOutcome outcome;
  std::deque<FormatExport> exports;  // they cannot move
  for (const FormatEntry* entry : formats) {
    Status begun = begin_export(dataset, *entry, options, exports);
    if (begun) continue;
    if (begun.error().kind != ErrorKind::kInput) return forward_error(begun);
    outcome.impossible.push_back({entry->name, begun.error()});
  }
  if (exports.empty()) return none_possible(outcome.impossible);
  if (Status ran = ExportRun(dataset, options, exports).run(); !ran) return forward_error(ran);
  for (FormatExport& each : exports) {
    if (const Error* refusal = each.refusal()) {
      outcome.impossible.push_back({each.summary().format, *refusal});
    } else if (Status finished = each.finish(); !finished) {
      return forward_error(finished);
    }
  }
  if (outcome.impossible.size() == formats.size()) return none_possible(outcome.impossible);
  for (FormatExport& each : exports) {
    if (each.refusal() != nullptr) continue;
    if (Status committed = each.commit(); !committed) return forward_error(committed);
    add_warnings(dataset, each.summary());
    outcome.written.push_back(std::move(each.summary()));
  }
  return outcome;
}

}  // namespace seedframe
