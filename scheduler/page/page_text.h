// A page as the text of an HTML file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/canonical_json.h"

namespace seedframe {

/// For a <script type="application/json">: canonical, with what could end the element escaped.
std::string script_json(const Json& value);

/// For text between tags and in quoted attributes.
std::string html_text(std::string_view text);

/// All of a page but the parts that follow it: it begins to work as soon as it has been read so
/// far. `connects`: whether it may ask where it came from for more (a page of `seedframe serve`);
/// `loads_parts`: whether it may load scripts from the folder beside it. Anything else is forbidden
/// to it by its Content-Security-Policy.
struct PageText {
  std::string begin;
  std::string end;
};
struct PageAccess {
  bool connects = false;
  bool loads_parts = false;
};
PageText page_text(const Json& data, const PageAccess& access);

/// An element for PageText, between begin and end.
std::string part_element(int part, const Json& content);

}  // namespace seedframe
