#include "export/verify.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>

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
    task->part = written_.take(task->frame.index);
    if (task->part) {
      for (const IndexEntry::File& file : task->part->entry.files) {
        listed_ += fs::exists(folder_ / file.path) ? 1 : 0;
      }
    }
    return task;
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
    while (const auto rest = written_.next()) {
      add_difference(
          fmt::format("frame {} is in the export, and not in the campaign", rest->entry.frame));
    }
    written_.open_empty_documents();
    for (const std::string& name : written_.not_read_to_the_end()) {
      add_difference(name + " holds entries that belong to no frame, or cannot be read");
    }
    for (const std::string& difference : format_.differences_at_end(folder_)) {
      add_difference(difference);
    }
    count_files();
  }

  /// Files that no frame and no document accounts for.
  void count_files() {
    std::int64_t found = 0;
    std::int64_t documents = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
      if (!entry->is_regular_file()) continue;
      const std::string path = fs::relative(entry->path(), folder_).string();
      const bool document = is_document(path);
      documents += document;
      const bool shared =
          document || path == kMarkerFile || path == kIndexFile || format_.is_common_file(path);
      if (!shared) ++found;
    }
    if (documents > written_.documents()) {
      add_difference(
          fmt::format("{} shared files belong to no frame", documents - written_.documents()));
    }
    if (found > listed_) {
      add_difference(fmt::format("{} files belong to no frame", found - listed_));
    }
  }

  bool is_document(const std::string& path) const {
    for (const SplitShare& split : marker_.options.splits) {
      for (const DocumentKind& kind : documents_) {
        if (is_document_of(path, kind, split.name)) return true;
      }
    }
    return false;
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
  Status outcome_;  ///< of reading the source
  std::int64_t listed_ = 0;
  VerifySummary summary_;
};

}  // namespace

Result<VerifySummary> verify_export(const Dataset& dataset, const FormatList& formats,
                                    const fs::path& folder, int workers) {
  const auto marker = read_marker(folder);
  if (!marker) return forward_error(marker);
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
