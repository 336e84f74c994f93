#include "export/document.h"

#include <fmt/format.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Where `text` stands first at or after `begin`, found without the whole file in memory.
std::optional<std::uint64_t> find_text(std::ifstream& file, std::uint64_t begin,
                                       const std::string& text) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::string window;
  std::uint64_t window_begin = begin;
  file.clear();
  file.seekg(static_cast<std::streamoff>(begin));
  while (true) {
    const std::size_t kept = window.size();
    window.resize(kept + kBlock);
    file.read(window.data() + kept, kBlock);
    window.resize(kept + static_cast<std::size_t>(file.gcount()));
    const std::size_t found = window.find(text);
    if (found != std::string::npos) return window_begin + found;
    if (!file) return std::nullopt;
    const std::size_t keep = std::min(window.size(), text.size() - 1);
    window_begin += window.size() - keep;
    window.erase(0, window.size() - keep);
  }
}

std::string read_at(std::ifstream& file, std::uint64_t position, std::uint64_t bytes) {
  std::string text(bytes, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(position));
  file.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

std::string DocumentKind::path_of(const std::string& split, int scene_index,
                                  std::int64_t shard_index) const {
  const std::string scene = fmt::format("{:06}", scene_index);
  const std::string shard = fmt::format("{:06}", shard_index);
  return fmt::format(fmt::runtime(path), fmt::arg("split", split), fmt::arg("scene", scene),
                     fmt::arg("shard", shard));
}

bool is_document_of(const std::string& path, const DocumentKind& kind, const std::string& split) {
  // The number of a scene or shard is all digits between the texts before and behind it.
  const std::string before = kind.path_of(split, 0, 0);
  const std::string number = "000000";
  if (kind.scope == DocumentKind::Scope::kSplit) return path == before;
  const std::size_t at = before.rfind(number);
  const std::size_t behind = before.size() - at - number.size();
  return path.size() >= before.size() && path.compare(0, at, before, 0, at) == 0 &&
         path.compare(path.size() - behind, behind, before, at + number.size(), behind) == 0 &&
         std::all_of(path.begin() + static_cast<std::ptrdiff_t>(at),
                     path.end() - static_cast<std::ptrdiff_t>(behind),
                     [](char c) { return c >= '0' && c <= '9'; });
}

DocumentWriter::DocumentWriter(fs::path path, const DocumentKind& kind)
    : path_(std::move(path)), kind_(kind) {
  sections_.reserve(kind.breaks.size() + 1);
  for (std::size_t i = 0; i <= kind.breaks.size(); ++i) {
    fs::path section = path_;
    if (i > 0) section += fmt::format(".section{}", i);
    std::ofstream file(section, std::ios::binary);
    sections_.push_back({std::move(section), std::move(file), false});
  }
  sections_.front().file << kind.header;
}

void DocumentWriter::add(int section, std::string_view chunk) {
  Section& out = sections_[static_cast<std::size_t>(section)];
  if (out.has_chunk) out.file << kind_.separator;
  out.file << chunk;
  out.has_chunk = true;
}

Status DocumentWriter::finish() {
  std::ofstream& file = sections_.front().file;
  bool whole = true;
  for (std::size_t i = 1; i < sections_.size(); ++i) {
    Section& section = sections_[i];
    section.file.close();
    file << kind_.breaks[i - 1];
    if (section.has_chunk) {
      const std::ifstream chunks(section.path, std::ios::binary);
      file << chunks.rdbuf();
    }
    std::error_code error;
    fs::remove(section.path, error);
    whole = whole && section.file && !error;
  }
  file << kind_.footer;
  file.close();
  if (whole && file) return {};
  return fail(ErrorKind::kEnvironment, "cannot write {}: is the disk full?", path_.string());
}

std::optional<DocumentReader> DocumentReader::open(const fs::path& path, const DocumentKind& kind) {
  DocumentReader reader;
  reader.separator_ = kind.separator;
  reader.file_.open(path, std::ios::binary | std::ios::ate);
  if (!reader.file_) return std::nullopt;
  const auto size = static_cast<std::uint64_t>(reader.file_.tellg());
  if (size < kind.header.size() + kind.footer.size() ||
      read_at(reader.file_, 0, kind.header.size()) != kind.header ||
      read_at(reader.file_, size - kind.footer.size(), kind.footer.size()) != kind.footer) {
    return std::nullopt;
  }
  std::uint64_t begin = kind.header.size();
  for (const std::string& section_break : kind.breaks) {
    const auto end = find_text(reader.file_, begin, section_break);
    if (!end) return std::nullopt;
    reader.sections_.push_back({begin, *end, false});
    begin = *end + section_break.size();
  }
  reader.sections_.push_back({begin, size - kind.footer.size(), false});
  return reader;
}

std::optional<std::string> DocumentReader::next(int index, std::uint64_t bytes) {
  Section& section = sections_[static_cast<std::size_t>(index)];
  const std::size_t separator = section.begun ? separator_.size() : 0;
  if (section.end - section.position < separator ||
      section.end - section.position - separator < bytes) {
    return std::nullopt;
  }
  std::string text = read_at(file_, section.position, separator + bytes);
  section.position += separator + bytes;
  section.begun = true;
  if (text.size() != separator + bytes || text.compare(0, separator, separator_, 0, separator) != 0)
    return std::nullopt;
  text.erase(0, separator);
  return text;
}

bool DocumentReader::at_end() const {
  return std::all_of(sections_.begin(), sections_.end(),
                     [](const Section& section) { return section.position == section.end; });
}

}  // namespace seedframe
