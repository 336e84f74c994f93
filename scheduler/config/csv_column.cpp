#include "config/csv_column.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/files.h"
#include "base/nearest_name.h"
#include "config/config_text.h"

namespace seedframe {
namespace {

constexpr std::size_t kLargestTable = 256u << 20;  // bytes
constexpr std::size_t kMostColumns = 10'000;
constexpr std::size_t kMostRows = 10'000'000;

/// Takes one record off the front of `text`; a quoted field may hold commas, quotes ("") and line
/// breaks. `lines` counts the line breaks that were passed. Fields behind the first `most` become
/// one.
std::vector<std::string> take_record(std::string_view& text, std::size_t& lines, std::size_t most) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  std::size_t i = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++lines;
    if (quoted) {
      if (c != '"') {
        fields.back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        fields.back() += '"';
        ++i;
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      if (fields.size() <= most) fields.emplace_back();
    } else if (c == '\n') {
      ++i;
      break;
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  text.remove_prefix(i);
  return fields;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

}  // namespace

Result<std::vector<double>> read_csv_column(const std::filesystem::path& file,
                                            const std::string& column) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return fail(ErrorKind::kInput, "there is no file {} (paths start at the config's folder)",
                file.string());
  }
  const Result<std::string> content = read_file(file, kLargestTable);
  if (!content) return fail(ErrorKind::kInput, "{}", content.error().message);
  std::string_view text = *content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  std::size_t line = 1;
  std::vector<std::string> names = take_record(text, line, kMostColumns);
  if (names.size() > kMostColumns) {
    return fail(ErrorKind::kInput, "{} has more than {} columns", file.string(), kMostColumns);
  }
  for (std::string& name : names) name = std::string(trimmed(name));
  const auto found = std::find(names.begin(), names.end(), column);
  if (found == names.end()) {
    return fail(ErrorKind::kInput, "{} has no column '{}'{}", file.string(), column,
                did_you_mean(column, names));
  }
  const auto index = static_cast<std::size_t>(found - names.begin());
  std::vector<double> values;
  while (!text.empty()) {
    const std::size_t row = line;
    const std::vector<std::string> fields = take_record(text, line, index + 1);
    if (fields.size() == 1 && trimmed(fields[0]).empty()) continue;  // an empty line
    const std::string_view cell =
        index < fields.size() ? trimmed(fields[index]) : std::string_view();
    const std::optional<double> value = parse_double(cell);
    if (!value || !std::isfinite(*value)) {
      constexpr std::size_t kMostShown = 60;
      return fail(ErrorKind::kInput, "{}:{}: column '{}' needs a finite number, found '{}'",
                  file.string(), row, column, cell.substr(0, kMostShown));
    }
    if (values.size() == kMostRows) {
      return fail(ErrorKind::kInput, "{} has more than {} rows", file.string(), kMostRows);
    }
    values.push_back(*value);
  }
  if (values.empty()) return fail(ErrorKind::kInput, "{} has no rows", file.string());
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace seedframe
