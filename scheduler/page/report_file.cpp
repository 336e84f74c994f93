#include "page/report_file.h"

#include <algorithm>

#include "base/files.h"
#include "base/utf8.h"
#include "page/page_text.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartPrefix = "part-";

/// Ours to replace: it holds parts of a report, or nothing.
Status check_parts_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return {};
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPartPrefix) && name.ends_with(".js")) continue;
    return fail(
        ErrorKind::kInput,
        "{} is where the report's pictures would go, and holds {}, which is not of a report: "
        "move it away, or name another file with -o",
        folder.string(), name);
  }
  return {};
}

/// Takes parts as they come: elements of the page, or files in a folder that gets its name at the
/// end.
class PartWriter {
 public:
  explicit PartWriter(fs::path folder) : folder_(std::move(folder)) {}
  ~PartWriter() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(unfinished(), error);
  }
  PartWriter(const PartWriter&) = delete;
  PartWriter& operator=(const PartWriter&) = delete;

  Status begin() {
    if (folder_.empty()) return {};
    if (Status free = check_parts_folder(folder_); !free) return free;
    std::error_code error;
    fs::remove_all(unfinished(), error);
    return make_folders(unfinished());
  }
  Status take(int part, const Json& content) {
    if (folder_.empty()) {
      elements_ += part_element(part, content);
      return {};
    }
    return write_file_unsynced(unfinished() / fmt::format("{}{}.js", kPartPrefix, part),
                               fmt::format("seedframePart({}, {});\n", part, script_json(content)));
  }
  Status finish() { return folder_.empty() ? Status() : replace_folder(unfinished(), folder_); }
  const std::string& elements() const { return elements_; }

 private:
  fs::path unfinished() const { return folder_.string() + ".new"; }

  fs::path folder_;
  std::string elements_;
};

bool is_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path parent = file.has_parent_path() ? file.parent_path() : fs::path(".");
  return fs::equivalent(parent, folder, error) && !error;
}

}  // namespace

Result<WrittenReport> write_report(const Campaign& campaign, const PreparedCampaign* prepared,
                                   const std::string& why_not, const ReportWish& wish) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  WrittenReport written;
  written.frames = counts->total();
  written.shown = std::min(written.frames, wish.page.most_frames);
  if (written.shown > wish.most_inside) {
    written.folder = wish.file;
    written.folder.replace_filename(wish.file.stem().string() + "_files");
  }
  PartWriter parts(written.folder);
  if (Status begun = parts.begin(); !begun) return forward_error(begun);
  Result<Json> data =
      campaign_page(campaign, prepared, why_not, wish.page,
                    [&parts](int part, const Json& content) { return parts.take(part, content); });
  if (!data) return forward_error(data);
  if (!written.folder.empty()) {
    (*data)["parts"]["folder"] = as_utf8(written.folder.filename().string());
  }
  (*data)["beside"] = is_in(wish.file, campaign.files.root());
  const PageText page =
      page_text(*data, {.connects = false, .loads_parts = !written.folder.empty()});
  if (Status done = parts.finish(); !done) return forward_error(done);
  const std::string text = page.begin + parts.elements() + page.end;
  if (Status done = write_file_atomically(wish.file, text); !done) return forward_error(done);
  written.bytes = text.size();
  written.damaged = data->at("summary").at("damaged").get<std::int64_t>();
  for (const Json& finding : data->at("health")) {
    written.warnings += finding.at("level") == "warning" ? 1 : 0;
  }
  return written;
}

}  // namespace seedframe
