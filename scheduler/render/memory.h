// Memory of the machine, as the kernel tells it.
#pragma once

#include <cstdint>

namespace seedframe {

/// Bytes; 0 if unknown.
std::int64_t system_memory_bytes();

/// Processes that the kernel has killed for lack of memory since it started (proc(5), vmstat); 0 if
/// unknown.
std::int64_t system_out_of_memory_kills();

}  // namespace seedframe
