#include "audit/export_check.h"

#include <algorithm>

#include "export/export_index.h"
#include "export/verify.h"

namespace seedframe {
namespace {

AuditedExport check_export(const Dataset& dataset, const FormatList& formats, const char* format,
                           const std::filesystem::path& folder, int threads) {
  Result<VerifySummary> summary = verify_export(dataset, formats, folder, threads);
  if (!summary) return {format, 0, 1, {summary.error().message}};
  return {format, summary->frames, summary->differences, std::move(summary->first_differences)};
}

}  // namespace

std::vector<AuditedExport> check_exports(const Dataset& dataset, const FormatList& formats,
                                         const std::filesystem::path& exports, int threads) {
  std::vector<AuditedExport> checked;
  for (const FormatEntry& format : formats) {
    const std::filesystem::path folder = exports / format.name;
    std::error_code error;
    if (!std::filesystem::exists(folder / kMarkerFile, error)) continue;
    checked.push_back(check_export(dataset, formats, format.name, folder, threads));
  }
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(exports, error)) {
    const std::string name = entry.path().filename().string();
    const bool looked_at =
        std::any_of(checked.begin(), checked.end(),
                    [&](const AuditedExport& each) { return each.format == name; });
    const bool is_left =
        name.starts_with('.') && name.ends_with(".partial");  // of one that was killed
    if (looked_at || is_left) continue;
    checked.push_back({name, 0, 1, {fmt::format("{} is not an export", entry.path().string())}});
  }
  return checked;
}

}  // namespace seedframe
