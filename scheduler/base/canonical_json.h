// One text for one value: the JSON that is hashed and stored.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace seedframe {

using Json = nlohmann::json;

/// Keys in byte order, no white space, numbers as the shortest text that reads back as the same
/// double, -0 as 0, whole doubles below 2^53 as integers (1, not 1.0). NaN and infinities have no
/// JSON: they are a programmer's mistake here and abort.
std::string canonical_json(const Json& value);

/// Appends a number, or a text with its quotes, as canonical_json writes it: for writers of large
/// values that need no tree.
void append_canonical(std::string& out, double value);
void append_canonical(std::string& out, std::string_view text);

/// The same value laid out for people, two spaces a level, with the same numbers; ends in a
/// newline.
std::string readable_json(const Json& value);

/// Parses text; `what` names it in the error.
Result<Json> parse_json(std::string_view text, const std::string& what);

/// value[key] as a T, or an error that names `what`, the key and the type that was expected.
template <class T>
Result<T> json_field(const Json& object, const char* key, const std::string& what) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' is missing", what, key);
  }
  try {
    return found->template get<T>();
  } catch (const Json::exception&) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' has the wrong type ({})", what, key,
                found->type_name());
  }
}

}  // namespace seedframe
