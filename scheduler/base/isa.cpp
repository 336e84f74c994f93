#include "base/isa.h"

#include <algorithm>
#include <array>

namespace seedframe {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"sse2", "sse41", "sse42", "avx", "avx2"};

}  // namespace

const char* to_string(Isa isa) { return kNames[static_cast<std::size_t>(isa)].data(); }

std::optional<Isa> isa_of(std::string_view name) {
  const auto* found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Isa>(found - kNames.begin());
}

std::vector<std::string> isa_names() { return {kNames.begin(), kNames.end()}; }

}  // namespace seedframe
