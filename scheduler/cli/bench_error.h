// The part of `seedframe bench` that measures error against run time.
#pragma once

#include "cli/verb.h"

namespace CLI {
class App;
}

namespace seedframe {

void add_bench_error(CLI::App& bench, const OnSelected& on_selected);

}  // namespace seedframe
