#include "base/canonical_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

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

struct Layout {
  bool readable;
};

void append_newline(std::string& out, int depth) {
  out += '\n';
  out.append(2 * static_cast<std::size_t>(depth), ' ');
}

bool is_flat(const Json& array) {
  for (const Json& item : array) {
    if (item.is_structured()) return false;
  }
  return true;
}

void append(std::string& out, const Json& value, Layout layout, int depth) {
  switch (value.type()) {
    case Json::value_t::number_float:
      append_canonical(out, value.get<double>());
      return;
    case Json::value_t::array: {
      const bool lines = layout.readable && !is_flat(value);
      out += '[';
      bool first = true;
      for (const Json& item : value) {
        if (!first) out += layout.readable && !lines ? ", " : ",";
        if (lines) append_newline(out, depth + 1);
        append(out, item, layout, depth + 1);
        first = false;
      }
      if (lines && !first) append_newline(out, depth);
      out += ']';
      return;
    }
    case Json::value_t::object: {
      out += '{';
      bool first = true;
      for (const auto& [key, item] : value.items()) {
        if (!first) out += ',';
        if (layout.readable) append_newline(out, depth + 1);
        append_canonical(out, std::string_view(key));
        out += layout.readable ? ": " : ":";
        append(out, item, layout, depth + 1);
        first = false;
      }
      if (layout.readable && !first) append_newline(out, depth);
      out += '}';
      return;
    }
    default:
      out += value.dump();
  }
}

}  // namespace

std::string canonical_json(const Json& value) {
  std::string out;
  append(out, value, {.readable = false}, 0);
  return out;
}

std::string readable_json(const Json& value) {
  std::string out;
  append(out, value, {.readable = true}, 0);
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
