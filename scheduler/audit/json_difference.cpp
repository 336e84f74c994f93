#include "audit/json_difference.h"

#include <algorithm>

#include <fmt/format.h>

namespace seedframe {
namespace {

std::string short_text(const Json& value) {
  constexpr std::size_t kLongest = 24;
  std::string text = value.is_string() ? value.get<std::string>() : canonical_json(value);
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;  // never inside of a character
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "…";
}

/// Of numbers only: a point, a colour, a matrix. One value, to a reader.
bool is_vector(const Json& value) {
  return value.is_array() &&
         std::all_of(value.begin(), value.end(), [](const Json& each) { return each.is_number(); });
}

class Walk {
 public:
  Walk(std::vector<std::string>& out, std::size_t most) : out_(out), most_(most) {}

  void values(const std::string& path, const Json& a, const Json& b) {
    if (a == b) return;
    if (a.is_object() && b.is_object()) return objects(path, a, b);
    if (is_vector(a) && is_vector(b)) {
      return add("{}: {}, here {}", path, short_text(a), short_text(b));
    }
    if (a.is_array() && b.is_array() && a.size() == b.size()) {
      for (std::size_t i = 0; i < a.size(); ++i) values(fmt::format("{}[{}]", path, i), a[i], b[i]);
      return;
    }
    if (a.is_array() && b.is_array()) {
      return add("{}: {} entries, here {}", path, a.size(), b.size());
    }
    add("{}: {}, here {}", path, short_text(a), short_text(b));
  }

  void end() {
    if (count_ > most_) out_.push_back(fmt::format("and {} more", count_ - most_));
  }

 private:
  void objects(const std::string& path, const Json& a, const Json& b) {
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const auto& [key, value] : a.items()) {
      if (b.contains(key)) {
        values(prefix + key, value, b[key]);
      } else {
        add("{}{}: not here", prefix, key);
      }
    }
    for (const auto& item : b.items()) {
      if (!a.contains(item.key())) add("{}{}: only here", prefix, item.key());
    }
  }
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    if (++count_ <= most_) out_.push_back(fmt::format(format, std::forward<Args>(args)...));
  }

  std::vector<std::string>& out_;
  std::size_t most_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<std::string> json_differences(const Json& expected, const Json& found,
                                          std::size_t most) {
  std::vector<std::string> differences;
  Walk walk(differences, most);
  walk.values("", expected, found);
  walk.end();
  return differences;
}

}  // namespace seedframe
