#include "export/earlier_export.h"

#include "base/canonical_json.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Documents of a scene or a shard follow one another; those of a split stay open.
constexpr std::size_t kMostOpenDocuments = 64;

}  // namespace

Result<EarlierExport> EarlierExport::open_for_reading(const fs::path& folder,
                                                      const std::vector<SplitShare>& splits,
                                                      const std::vector<DocumentKind>& documents) {
  EarlierExport earlier;
  earlier.splits_ = splits;
  earlier.folder_ = folder;
  earlier.kinds_ = documents;
  earlier.index_.open(folder / kIndexFile, std::ios::binary);
  if (!earlier.index_) {
    return fail(ErrorKind::kCorrupt, "{} is missing: export again", (folder / kIndexFile).string());
  }
  return earlier;
}

std::optional<EarlierExport> EarlierExport::open(const fs::path& folder, const ExportMarker& marker,
                                                 const std::vector<DocumentKind>& documents) {
  const auto found = read_marker(folder);
  if (!found || found->format != marker.format || found->campaign != marker.campaign ||
      found->dataset != marker.dataset || to_json(found->options) != to_json(marker.options)) {
    return std::nullopt;
  }
  auto earlier = open_for_reading(folder, marker.options.splits, documents);
  if (!earlier) return std::nullopt;
  return std::move(*earlier);
}

bool EarlierExport::read_entry() {
  if (entry_) return true;
  std::string line;
  if (!std::getline(index_, line)) return false;
  auto entry = parse_index_line(line, (folder_ / kIndexFile).string());
  if (!entry) return false;
  entry_ = std::move(*entry);
  return true;
}

std::optional<std::string> EarlierExport::read_piece(const IndexEntry::Piece& piece,
                                                     const std::string& split, int& document) {
  document = -1;
  for (std::size_t k = 0; k < kinds_.size() && document < 0; ++k) {
    if (is_document_of(piece.document, kinds_[k], split)) document = static_cast<int>(k);
  }
  if (document < 0 || piece.section < 0) return std::nullopt;
  const DocumentKind& kind = kinds_[static_cast<std::size_t>(document)];
  if (piece.section > static_cast<int>(kind.breaks.size())) return std::nullopt;
  auto found = open_documents_.find(piece.document);
  if (found == open_documents_.end()) {
    for (auto each = open_documents_.begin();
         open_documents_.size() >= kMostOpenDocuments && each != open_documents_.end();) {
      const Document& document_there = each->second;
      const bool over =
          !document_there.of_split && document_there.reader && document_there.reader->at_end();
      each = over ? open_documents_.erase(each) : std::next(each);
    }
    found =
        open_documents_
            .emplace(piece.document, Document{DocumentReader::open(folder_ / piece.document, kind),
                                              kind.scope == DocumentKind::Scope::kSplit})
            .first;
  }
  if (!found->second.reader) return std::nullopt;
  return found->second.reader->next(piece.section, piece.bytes);
}

EarlierExport::Part EarlierExport::read_part() {
  Part part;
  part.entry = std::move(*entry_);
  entry_.reset();
  const auto split = static_cast<std::size_t>(part.entry.split);
  part.whole = split < splits_.size();
  for (const IndexEntry::Piece& piece : part.entry.pieces) {
    if (split >= splits_.size()) break;
    Chunk chunk;
    auto text = read_piece(piece, splits_[split].name, chunk.document);
    part.whole = part.whole && text && content_hash(*text) == piece.hash;
    if (!text) continue;
    chunk.section = piece.section;
    chunk.text = std::move(*text);
    part.chunks.push_back(std::move(chunk));
  }
  return part;
}

std::optional<EarlierExport::Part> EarlierExport::next() {
  if (!read_entry()) return std::nullopt;
  return read_part();
}

std::optional<EarlierExport::Part> EarlierExport::take(std::int64_t frame) {
  while (read_entry() && entry_->frame < frame) read_part();
  if (!entry_ || entry_->frame != frame) return std::nullopt;
  return read_part();
}

void EarlierExport::open_empty_documents() {
  for (const DocumentKind& kind : kinds_) {
    if (kind.scope != DocumentKind::Scope::kSplit) continue;
    for (const SplitShare& split : splits_) {
      const std::string path = kind.path_of(split.name, 0, 0);
      if (open_documents_.count(path) > 0) continue;
      open_documents_.emplace(path, Document{DocumentReader::open(folder_ / path, kind), true});
    }
  }
}

std::vector<std::string> EarlierExport::not_read_to_the_end() const {
  std::vector<std::string> names;
  for (const auto& [name, document] : open_documents_) {
    if (!document.reader || !document.reader->at_end()) names.push_back(name);
  }
  return names;
}

}  // namespace seedframe
