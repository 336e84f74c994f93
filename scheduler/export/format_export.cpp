#include "export/format_export.h"

#include "base/sha256.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace fs = std::filesystem;

FormatExport::FormatExport(const FormatEntry& entry, std::unique_ptr<ExportFormat> format,
                           ExportFolder folder, const ExportOptions& options)
    : entry_(entry),
      format_(std::move(format)),
      kinds_(format_->documents()),
      folder_(std::move(folder)),
      options_(options) {
  summary_.format = entry.name;
  summary_.folder = folder_.destination();
  for (const SplitShare& split : options.splits) {
    summary_.splits.push_back({.split = split.name});
  }
}

Status FormatExport::begin(const Dataset& dataset) {
  marker_ = {entry_.name, dataset.name, dataset_hash(dataset), 0, options_};
  for (const fs::path& folder : format_->folders()) {
    if (Status made = folder_.make_folder(folder); !made) return made;
  }
  for (const DocumentKind& kind : kinds_) {
    if (kind.scope != DocumentKind::Scope::kSplit) continue;
    for (const SplitShare& split : options_.splits) {
      if (Status begun = open_document(kind, split.name, 0, 0); !begun) return begun;
    }
  }
  index_.open(folder_.partial() / kIndexFile, std::ios::binary);
  if (format_->reusable()) {
    earlier_ = EarlierExport::open(folder_.destination(), marker_, kinds_);
  }
  return {};
}

std::optional<EarlierExport::Part> FormatExport::take_earlier(std::int64_t frame) {
  return earlier_ ? earlier_->take(frame) : std::nullopt;
}

bool FormatExport::reuse(const EarlierExport::Part& part, const FrameReader& files,
                         FrameRecord& record) const {
  if (!part.whole || part.entry.key != files.key()) return false;
  const std::string image_sha256 = files.sha256(files.image_file());
  for (const IndexEntry::File& file : part.entry.files) {
    if (options_.link_images && file.hash == content_hash_of_sha256(image_sha256)) {
      record.placed.push_back({file.path, files.path(files.image_file()), image_sha256});
      continue;
    }
    const fs::path source = earlier_->folder() / file.path;
    const auto sha256 = sha256_of_file(source);
    if (!sha256 || content_hash_of_sha256(*sha256) != file.hash) return false;
    record.placed.push_back({file.path, source, *sha256});
  }
  record.chunks = part.chunks;
  record.counts = part.entry.counts;
  return true;
}

Status FormatExport::write_files(const FrameRecord& record, bool reused, IndexEntry& entry) {
  for (const FrameFile& file : record.files) {
    if (Status written = folder_.write(file.path, file.bytes); !written) return written;
    entry.files.push_back({file.path.string(), content_hash(file.bytes)});
  }
  for (const PlacedFile& file : record.placed) {
    // What is taken over from an export that is about to be removed can stay where it is on the
    // disk, unless it is also an image of the campaign.
    std::error_code error;
    const bool link =
        options_.link_images || (reused && fs::hard_link_count(file.source, error) == 1 && !error);
    if (Status placed = folder_.place(file.source, file.path, link); !placed) return placed;
    entry.files.push_back({file.path.string(), content_hash_of_sha256(file.sha256)});
  }
  return {};
}

Status FormatExport::append(const CommittedFrame& frame, std::int64_t ordinal,
                            const FrameRecord& record, bool reused, IndexEntry entry) {
  SplitSummary& split = summary_.splits[static_cast<std::size_t>(entry.split)];
  const std::int64_t shard = ordinal / options_.shard_size;
  for (const Chunk& chunk : record.chunks) {
    const DocumentKind& kind = kinds_[static_cast<std::size_t>(chunk.document)];
    if (Status open = open_document(kind, split.split, frame.scene, shard); !open) return open;
    const std::string path = kind.path_of(split.split, frame.scene, shard);
    documents_.at(path).writer.add(chunk.section, chunk.text);
    entry.pieces.push_back({path, chunk.section, chunk.text.size(), content_hash(chunk.text)});
  }
  entry.counts = record.counts;
  index_ << index_line(entry);
  ++summary_.frames;
  summary_.reused += reused;
  ++split.images;
  split.background_images += at(record.counts, Count::kAnnotations) == 0;
  for (std::size_t i = 0; i < split.counts.size(); ++i) split.counts[i] += record.counts[i];
  for (const IndexEntry::File& file : entry.files) {
    summary_.folders.insert(fs::path(file.path).parent_path());
  }
  return {};
}

void FormatExport::give_up(Error why) {
  refusal_ = std::move(why);
  given_up_ = true;
}

Status FormatExport::finish() {
  for (auto& [path, document] : documents_) {
    if (Status closed = document.writer.finish(); !closed) return closed;
  }
  index_.close();
  if (!index_) {
    return fail(ErrorKind::kEnvironment, "cannot write {}: is the disk full?",
                (folder_.partial() / kIndexFile).string());
  }
  marker_.frames = summary_.frames;
  auto common = format_->common_part(summary_);
  if (!common) return forward_error(common);
  for (const fs::path& folder : common->folders) {
    if (Status made = folder_.make_folder(folder); !made) return made;
  }
  for (const auto& [path, bytes] : common->files) {
    if (Status written = folder_.write(path, bytes); !written) return written;
  }
  std::move(common->warnings.begin(), common->warnings.end(),
            std::back_inserter(summary_.warnings));
  return {};
}

Status FormatExport::commit() { return folder_.commit(marker_text(marker_)); }

Status FormatExport::open_document(const DocumentKind& kind, const std::string& split, int scene,
                                   std::int64_t shard) {
  const std::string path = kind.path_of(split, scene, shard);
  if (documents_.count(path) > 0) return {};
  for (auto each = documents_.begin(); each != documents_.end();) {
    const bool over = each->second.kind == &kind && each->second.split == split;
    if (!over) {
      ++each;
      continue;
    }
    if (Status closed = each->second.writer.finish(); !closed) return closed;
    each = documents_.erase(each);
  }
  const fs::path relative = path;
  if (Status made = folder_.make_folder(relative.parent_path()); !made) return made;
  documents_.emplace(path, OpenDocument{&kind, split, {folder_.partial() / relative, kind}});
  return {};
}

}  // namespace seedframe
