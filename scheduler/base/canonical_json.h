// One text for one value: the JSON that is hashed and stored.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

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

/// Parses text; `what` names it in the error. Values in more than 100 levels are an error, too:
/// copying and printing take stack for each.
Result<Json> parse_json(std::string_view text, const std::string& what);

/// The integer that a value is, if it is one and a T can hold it; booleans and fractions are not.
/// Json's own get would cut a number to the type's bits.
template <std::integral T>
std::optional<T> integer_in(const Json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    return std::in_range<T>(number) ? std::optional(static_cast<T>(number)) : std::nullopt;
  }
  if (!value.is_number_integer()) return std::nullopt;
  const auto number = value.get<std::int64_t>();
  return std::in_range<T>(number) ? std::optional(static_cast<T>(number)) : std::nullopt;
}

/// The same for readers that catch Json::exception: throws one where there is no such integer.
template <std::integral T>
T integer_of(const Json& value) {
  if (const auto number = integer_in<T>(value)) return *number;
  throw Json::type_error::create(
      302,
      fmt::format("expected an integer from {} to {}", std::numeric_limits<T>::min(),
                  std::numeric_limits<T>::max()),
      &value);
}

/// value[key] as a T, or an error that names `what`, the key and the type that was expected.
template <class T>
Result<T> json_field(const Json& object, const char* key, const std::string& what) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' is missing", what, key);
  }
  if constexpr (std::integral<T> && !std::same_as<T, bool>) {
    if (const auto number = integer_in<T>(*found)) return *number;
    return fail(ErrorKind::kCorrupt, "{}: key '{}' must be an integer from {} to {}", what, key,
                std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
  } else {
    try {
      return found->template get<T>();
    } catch (const Json::exception&) {
      return fail(ErrorKind::kCorrupt, "{}: key '{}' has the wrong type ({})", what, key,
                  found->type_name());
    }
  }
}

}  // namespace seedframe
