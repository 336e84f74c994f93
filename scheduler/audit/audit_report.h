// An audit told to programs and to people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "audit/audit.h"
#include "audit/export_check.h"
#include "base/canonical_json.h"

namespace seedframe {

/// report.json; docs/formats/audit.md.
Json to_json(const Audit& audit, const std::vector<AuditedExport>& exports);

/// report.md: Markdown, with the pictures of what differs. `title` names the campaign.
std::string audit_markdown(const std::string& title, const Audit& audit,
                           const std::vector<AuditedExport>& exports);

/// A paragraph for a terminal: a line for each thing that was looked at.
std::string audit_summary(const Audit& audit, const std::vector<AuditedExport>& exports);

/// Makes or empties the folder of an audit. A kInput error for one that holds anything else.
Status take_audit_folder(const std::filesystem::path& folder);

/// Writes report.md and report.json.
Status write_audit_report(const std::filesystem::path& folder, const std::string& title,
                          const Audit& audit, const std::vector<AuditedExport>& exports);

}  // namespace seedframe
