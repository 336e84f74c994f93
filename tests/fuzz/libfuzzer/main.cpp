// The entry point that libFuzzer calls; SEEDFRAME_FUZZ_TARGET is one function of targets.h.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  seedframe::SEEDFRAME_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
