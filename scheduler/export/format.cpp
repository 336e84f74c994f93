#include "export/format.h"

#include "base/nearest_name.h"

namespace seedframe {

Result<const FormatEntry*> find_format(const FormatList& formats, std::string_view name) {
  std::vector<std::string> names;
  for (const FormatEntry& format : formats) {
    if (format.name == name) return &format;
    names.emplace_back(format.name);
  }
  return fail(ErrorKind::kInput, "there is no export format '{}'{}", name,
              did_you_mean(name, names));
}

}  // namespace seedframe
