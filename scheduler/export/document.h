// Files that frames share, written as a stream: a JSON file with an array or two, a list, a tar.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

struct DocumentKind {
  enum class Scope { kSplit, kScene, kShard };
  std::string path;  ///< with {split}, {scene} (six digits) and {shard} (six digits) in it
  Scope scope = Scope::kSplit;
  std::string header;
  std::vector<std::string> breaks;  ///< between two sections; one section has none
  std::string footer;
  std::string separator;  ///< between two chunks of a section; no chunk may hold breaks or footer

  std::string path_of(const std::string& split, int scene, std::int64_t shard) const;
};

/// Whether a relative path can be one of a kind's documents in a split.
bool is_document_of(const std::string& path, const DocumentKind& kind, const std::string& split);

/// header, chunks of section 0, break, chunks of section 1, …, footer. The sections after the first
/// are kept in files beside it until finish().
class DocumentWriter {
 public:
  DocumentWriter(std::filesystem::path path, const DocumentKind& kind);

  void add(int section, std::string_view chunk);
  /// Must be called last; reports any write that failed since the document was begun.
  Status finish();

 private:
  struct Section {
    std::filesystem::path path;
    std::ofstream file;
    bool has_chunk = false;
  };
  std::filesystem::path path_;
  DocumentKind kind_;
  std::vector<Section> sections_;  ///< the first one's path is the document's
};

/// Reads a document back, section by section, chunk by chunk.
class DocumentReader {
 public:
  /// None if the file is not there, or not of the kind: its header, breaks and footer.
  static std::optional<DocumentReader> open(const std::filesystem::path& path,
                                            const DocumentKind& kind);

  /// The next `bytes` of a section, after the separator that stands between chunks; none when the
  /// section is over earlier.
  std::optional<std::string> next(int section, std::uint64_t bytes);
  /// Whether all of every section has been read.
  bool at_end() const;

 private:
  struct Section {
    std::uint64_t position = 0;
    std::uint64_t end = 0;
    bool begun = false;
  };
  std::ifstream file_;
  std::string separator_;
  std::vector<Section> sections_;
};

}  // namespace seedframe
