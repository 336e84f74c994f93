#include "base/canonical_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "base/canonical_writer.h"
#include "base/message_text.h"

namespace seedframe {

void append_canonical(std::string& out, double value) {
  if (!std::isfinite(value)) {
    std::fputs("canonical_json: a number is not finite\n", stderr);
    std::abort();
  }
  if (value == 0.0) value = 0.0;  // -0 and 0 are one value
  std::array<char, 40> text{};
  constexpr double kLargestExactInteger = 9007199254740992.0;
  const bool whole = value == std::floor(value) && std::abs(value) < kLargestExactInteger;
  const auto end = whole ? std::to_chars(text.begin(), text.end(), static_cast<long long>(value))
                         : std::to_chars(text.begin(), text.end(), value);
  out.append(text.data(), end.ptr);
}

void append_canonical(std::string& out, std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return c >= ' ' && c <= '~' && c != '"' && c != '\\';
  });
  if (!plain) {
    out += Json(text).dump();
    return;
  }
  out += '"';
  out += text;
  out += '"';
}

namespace {

void append(std::string& out, const Json& value) {
  switch (value.type()) {
    case Json::value_t::number_float:
      append_canonical(out, value.get<double>());
      return;
    case Json::value_t::array: {
      out += '[';
      bool first = true;
      for (const Json& item : value) {
        if (!first) out += ',';
        append(out, item);
        first = false;
      }
      out += ']';
      return;
    }
    case Json::value_t::object: {
      out += '{';
      bool first = true;
      for (const auto& [key, item] : value.items()) {
        if (!first) out += ',';
        append_canonical(out, std::string_view(key));
        out += ':';
        append(out, item);
        first = false;
      }
      out += '}';
      return;
    }
    default:
      out += value.dump();
  }
}

/// Where a text ends that begins at a quotation mark.
std::size_t end_of_text(std::string_view json, std::size_t begin) {
  std::size_t at = begin + 1;
  for (; json[at] != '"'; ++at) {
    if (json[at] == '\\') ++at;
  }
  return at + 1;
}

/// Whether a list that begins at a bracket holds neither lists nor objects.
bool is_flat(std::string_view json, std::size_t begin) {
  std::size_t at = begin + 1;
  while (json[at] != ']') {
    if (json[at] == '[' || json[at] == '{') return false;
    at = json[at] == '"' ? end_of_text(json, at) : at + 1;
  }
  return true;
}

}  // namespace

std::string canonical_json(const Json& value) {
  std::string out;
  append(out, value);
  return out;
}

std::string readable_json(const Json& value) { return readable_layout(canonical_json(value)); }

std::string readable_layout(std::string_view canonical) {
  std::string out;
  out.reserve(canonical.size() * 3 / 2);
  std::vector<bool> in_lines;  // by level
  const auto new_line = [&] {
    out += '\n';
    out.append(2 * in_lines.size(), ' ');
  };
  for (std::size_t at = 0; at < canonical.size();) {
    const char c = canonical[at];
    std::size_t end = at + 1;
    if (c == ']' || c == '}') {
      const bool lines = in_lines.back();
      in_lines.pop_back();
      if (lines) new_line();
    } else if (c == '"') {
      end = end_of_text(canonical, at);
    } else if (c != '[' && c != '{' && c != ',' && c != ':') {
      end = std::min(canonical.find_first_of(",]}", at), canonical.size());
    }
    out += canonical.substr(at, end - at);
    if (c == ':' || (c == ',' && !in_lines.back())) out += ' ';
    if (c == ',' && in_lines.back()) new_line();
    if (c == '[' || c == '{') {
      if (canonical[end] == ']' || canonical[end] == '}') {
        out += canonical[end++];
      } else {
        in_lines.push_back(c == '{' || !is_flat(canonical, at));
        if (in_lines.back()) new_line();
      }
    }
    at = end;
  }
  out += '\n';
  return out;
}

namespace {

/// Of valid JSON; of anything else some number.
int levels_of(std::string_view text) {
  int level = 0;
  int most = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') most = std::max(most, ++level);
    if (c == ']' || c == '}') --level;
  }
  return most;
}

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& what) {
  constexpr int kMostLevels = 100;
  if (levels_of(text) > kMostLevels) {
    return fail(ErrorKind::kCorrupt, "{} is not valid JSON here: values in more than {} levels",
                what, kMostLevels);
  }
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    std::string reason = error.what();
    const auto close = reason.find("] ");
    if (close != std::string::npos) reason.erase(0, close + 2);
    return fail(ErrorKind::kCorrupt, "{} is not valid JSON: {}", what, shortened(reason, 300));
  }
}

}  // namespace seedframe
