#include "export/verify.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <unordered_set>

#include "base/files.h"
#include "export/earlier_export.h"
#include "export/export_index.h"
#include "export/frame_pipeline.h"
#include "export/split.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostTold = 20;

struct VerifyTask {
  CommittedFrame frame;
  std::optional<EarlierExport::Part> part;
  Status status;
  std::int64_t annotations = 0;
  std::vector<std::string> differences;
};

class Verification {
 public:
  Verification(const Dataset& dataset, const fs::path& folder, const ExportMarker& marker,
               const ExportFormat& format, EarlierExport written)
      : dataset_(dataset),
        folder_(folder),
        marker_(marker),
        format_(format),
        documents_(format.documents()),
        written_(std::move(written)),
        cursor_(dataset.frames()) {
    summary_.format = marker.format;
    for (const SplitShare& split : marker.options.splits) {
      shape_.splits.push_back({.split = split.name});
    }
  }

  Result<VerifySummary> run(int workers) {
    run_frame_pipeline<VerifyTask>(
        workers, [this] { return next(); },
        [this](VerifyTask& task) { task.status = compare(task); },
        [this](const VerifyTask& task) { take(task); });
    if (!outcome_) return forward_error(outcome_);
    finish();
    return std::move(summary_);
  }

 private:
  std::shared_ptr<VerifyTask> next() {
    if (failed_) return nullptr;
    auto frame = cursor_();
    if (!frame) fail_with(forward_error(frame));
    if (!frame || !*frame) return nullptr;
    auto task = std::make_shared<VerifyTask>();
    task->frame = std::move(**frame);
    task->part = take_part(task->frame.index);
    return task;
  }

  /// The part of a frame. Frames before it that the campaign does not have are kept for finish().
  std::optional<EarlierExport::Part> take_part(std::int64_t frame) {
    while (!ahead_ || ahead_->entry.frame < frame) {
      if (ahead_) strangers_.push_back(ahead_->entry.frame);
      ahead_ = written_.next();
      if (!ahead_) return std::nullopt;
      note_names(ahead_->entry);
    }
    if (ahead_->entry.frame != frame) return std::nullopt;
    return std::exchange(ahead_, std::nullopt);
  }

  void note_names(const IndexEntry& entry) {
    for (const IndexEntry::File& file : entry.files) {
      files_of_frames_.insert(std::hash<std::string>()(file.path));
      shape_.folders.insert(fs::path(file.path).parent_path());
    }
    for (const IndexEntry::Piece& piece : entry.pieces) documents_there_.insert(piece.document);
    ++shape_.frames;
    const auto split = static_cast<std::size_t>(entry.split);
    if (split < shape_.splits.size()) ++shape_.splits[split].images;
  }

  Status compare(VerifyTask& task) const {
    const auto files = FrameReader::open(task.frame, format_.needs());
    if (!files) return forward_error(files);
    auto loaded = files->load(dataset_.categories);
    if (!loaded) return forward_error(loaded);
    const ExportOptions& options = marker_.options;
    const int split = split_of_scene(task.frame.scene, dataset_.seed, options.splits);
    auto selected = select_instances(task.frame, std::move(*loaded),
                                     options.splits[static_cast<std::size_t>(split)].name, options);
    if (!selected) return forward_error(selected);
    if (!task.part) {
      task.differences.emplace_back("is not in the export");
      return {};
    }
    task.annotations = at(task.part->entry.counts, Count::kAnnotations);
    if (task.part->entry.split != split) {
      task.differences.emplace_back("belongs to another split");
    }
    if (!task.part->whole) {
      task.differences.emplace_back("an entry of it is missing, or not as it was written");
    }
    const WrittenFrame written = read_files(task, **selected);
    for (std::string& difference : format_.differences(**selected, written)) {
      task.differences.push_back(std::move(difference));
    }
    return compare_names(task, **selected);
  }

  /// The index must list all files that the frame should have: what it does not list is not read.
  Status compare_names(VerifyTask& task, const ExportFrame& frame) const {
    if (!format_.reusable()) return {};  // it has none, and encoding would count the frame again
    const auto record = format_.encode(frame);
    if (!record) return forward_error(record);
    std::set<std::string> expected;
    for (const FrameFile& file : record->files) expected.insert(file.path.string());
    for (const PlacedFile& file : record->placed) expected.insert(file.path.string());
    for (const IndexEntry::File& file : task.part->entry.files) {
      if (expected.erase(file.path) == 0) {
        task.differences.push_back(file.path + " is not one of its files");
      }
    }
    for (const std::string& path : expected) {
      task.differences.push_back(path + " is not in the export");
    }
    return {};
  }

  /// The frame's own files. Those that have the image's hash are the image, placed as it is.
  WrittenFrame read_files(VerifyTask& task, const ExportFrame& frame) const {
    WrittenFrame written;
    written.chunks = task.part->chunks;
    const std::string image = content_hash_of_sha256(frame.loaded.image_sha256);
    for (const IndexEntry::File& file : task.part->entry.files) {
      auto bytes = read_file(folder_ / file.path);
      if (!bytes) {
        task.differences.push_back(bytes.error().message);
        continue;
      }
      if (content_hash(*bytes) != file.hash) {
        task.differences.push_back(file.path + " is not as it was written");
      }
      if (image.empty() || file.hash != image) written.files[file.path] = std::move(*bytes);
    }
    return written;
  }

  void take(const VerifyTask& task) {
    if (!task.status) {
      fail_with(task.status);
      return;
    }
    ++summary_.frames;
    summary_.annotations += task.annotations;
    for (const std::string& difference : task.differences) {
      add_difference(fmt::format("frame {}: {}", task.frame.index, difference));
    }
  }

  /// Keeps the first error.
  void fail_with(const Status& status) {
    const std::lock_guard lock(outcome_mutex_);  // the cursor may fail while frames are taken
    if (!failed_) outcome_ = status;
    failed_ = true;
  }

  void finish() {
    static_cast<void>(take_part(std::numeric_limits<std::int64_t>::max()));
    for (const std::int64_t frame : strangers_) {
      add_difference(fmt::format("frame {} is in the export, and not in the campaign", frame));
    }
    written_.open_empty_documents();
    for (const std::string& name : written_.not_read_to_the_end()) {
      add_difference(name + " holds entries that belong to no frame, or cannot be read");
    }
    auto common = format_.common_part(shape_);
    if (!common) {
      add_difference(common.error().message);
      return;
    }
    common->files[kMarkerFile] = marker_text(
        {marker_.format, dataset_.name, dataset_hash(dataset_), shape_.frames, marker_.options});
    for (const auto& [path, bytes] : common->files) {
      const auto found = read_file(folder_ / path);
      if (!found || *found != bytes) {
        add_difference(found ? path + " is not what it should be" : found.error().message);
      }
    }
    for (const fs::path& folder : common->folders) {
      if (!fs::is_directory(folder_ / folder)) {
        add_difference(fmt::format("the folder {} is missing", folder.string()));
      }
    }
    name_strange_files(*common);
  }

  /// Files that no frame, no document and no format accounts for.
  void name_strange_files(const CommonPart& common) {
    for (const DocumentKind& kind : documents_) {
      if (kind.scope != DocumentKind::Scope::kSplit) continue;
      for (const SplitShare& split : marker_.options.splits) {
        documents_there_.insert(kind.path_of(split.name, 0, 0));
      }
    }
    std::error_code error;
    std::vector<std::string> strange;
    for (fs::recursive_directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->is_directory()) continue;
      std::string path = fs::relative(entry->path(), folder_).string();
      const bool known = path == kIndexFile || common.files.count(path) > 0 ||
                         documents_there_.count(path) > 0 ||
                         files_of_frames_.count(std::hash<std::string>()(path)) > 0 ||
                         format_.is_left_by_trainers(path);
      if (!known) strange.push_back(std::move(path));
    }
    std::sort(strange.begin(), strange.end());
    for (const std::string& path : strange) add_difference(path + " belongs to no frame");
  }

  void add_difference(std::string text) {
    ++summary_.differences;
    if (summary_.first_differences.size() < kMostTold) {
      summary_.first_differences.push_back(std::move(text));
    }
  }

  const Dataset& dataset_;
  const fs::path& folder_;
  const ExportMarker& marker_;
  const ExportFormat& format_;
  std::vector<DocumentKind> documents_;
  EarlierExport written_;
  FrameCursor cursor_;
  std::atomic<bool> failed_ = false;
  std::mutex outcome_mutex_;
  Status outcome_;                                   ///< of reading the source
  std::optional<EarlierExport::Part> ahead_;         ///< read, and not asked for yet
  std::vector<std::int64_t> strangers_;              ///< frames that the campaign does not have
  std::unordered_set<std::size_t> files_of_frames_;  ///< hashes of their paths
  std::set<std::string> documents_there_;
  ExportSummary shape_;  ///< what common_part asks for: images of splits, folders
  VerifySummary summary_;
};

}  // namespace

Result<VerifySummary> verify_export(const Dataset& dataset, const FormatList& formats,
                                    const fs::path& folder, int workers) {
  auto marker = read_marker(folder);
  if (!marker) return forward_error(marker);
  marker->options.workers = workers;
  const auto entry = find_format(formats, marker->format);
  if (!entry) return forward_error(entry);
  const auto format = (*entry)->make(dataset, marker->options);
  if (!format) return forward_error(format);
  auto written =
      EarlierExport::open_for_reading(folder, marker->options.splits, (*format)->documents());
  if (!written) return forward_error(written);
  return Verification(dataset, folder, *marker, **format, std::move(*written)).run(workers);
}

}  // namespace seedframe
