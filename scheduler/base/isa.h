// Instruction sets that renderers have kernels for.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace seedframe {

/// Least first.
enum class Isa { kSse2, kSse41, kSse42, kAvx, kAvx2 };

/// As configs and Cycles name it: "sse2", "sse41", "sse42", "avx", "avx2".
const char* to_string(Isa isa);
/// None for other words.
std::optional<Isa> isa_of(std::string_view name);
std::vector<std::string> isa_names();

}  // namespace seedframe
