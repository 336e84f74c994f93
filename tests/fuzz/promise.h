// What holds for every input, or the program has a bug.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace seedframe {

/// Ends the process, as a fuzzer and a unit test want it. Not assert: it holds in every build.
inline void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "fuzz: broken promise: %s\n", what);
  std::abort();
}

}  // namespace seedframe
