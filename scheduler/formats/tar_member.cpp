#include "formats/tar_member.h"

#include <cassert>
#include <memory>

#include <archive.h>
#include <archive_entry.h>

namespace seedframe {
namespace {

constexpr std::size_t kBlock = 512;

struct FreeArchive {
  void operator()(archive* a) const { archive_free(a); }
};
using ArchivePointer = std::unique_ptr<archive, FreeArchive>;
struct FreeEntry {
  void operator()(archive_entry* entry) const { archive_entry_free(entry); }
};

la_ssize_t append_bytes(archive*, void* out, const void* bytes, std::size_t count) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), count);
  return static_cast<la_ssize_t>(count);
}

}  // namespace

std::string tar_end() { return std::string(2 * kBlock, '\0'); }

Result<std::string> tar_member(const std::string& name, std::string_view content) {
  std::string bytes;
  const ArchivePointer writer(archive_write_new());
  archive_write_set_format_ustar(writer.get());
  archive_write_set_bytes_per_block(writer.get(), 0);  // as it comes
  archive_write_open(writer.get(), &bytes, nullptr, append_bytes, nullptr);
  const std::unique_ptr<archive_entry, FreeEntry> entry(archive_entry_new());
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(content.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), 0, 0);
  const bool written = archive_write_header(writer.get(), entry.get()) == ARCHIVE_OK &&
                       archive_write_data(writer.get(), content.data(), content.size()) ==
                           static_cast<la_ssize_t>(content.size()) &&
                       archive_write_finish_entry(writer.get()) == ARCHIVE_OK;
  if (!written) {
    const char* reason = archive_error_string(writer.get());
    return fail(ErrorKind::kEnvironment, "cannot put {} into a tar archive: {}", name,
                reason == nullptr ? "it is too large" : reason);
  }
  assert(bytes.size() % kBlock == 0);
  return bytes;
}

std::optional<std::vector<std::pair<std::string, std::string>>> read_tar_members(
    const std::string& members) {
  const std::string whole = members + tar_end();
  const ArchivePointer reader(archive_read_new());
  archive_read_support_format_tar(reader.get());
  if (archive_read_open_memory(reader.get(), whole.data(), whole.size()) != ARCHIVE_OK) {
    return std::nullopt;
  }
  std::vector<std::pair<std::string, std::string>> found;
  archive_entry* entry = nullptr;
  int status = archive_read_next_header(reader.get(), &entry);
  for (; status == ARCHIVE_OK; status = archive_read_next_header(reader.get(), &entry)) {
    const auto size = static_cast<std::size_t>(archive_entry_size(entry));
    if (size > members.size()) return std::nullopt;
    std::string content(size, '\0');
    if (archive_read_data(reader.get(), content.data(), size) != static_cast<la_ssize_t>(size)) {
      return std::nullopt;
    }
    found.emplace_back(archive_entry_pathname(entry), std::move(content));
  }
  if (status != ARCHIVE_EOF) return std::nullopt;
  return found;
}

}  // namespace seedframe
