// An audit told to programs and to people.
#pragma once

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

}  // namespace seedframe
