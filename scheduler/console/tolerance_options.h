// The options that say what colours may differ by, of all verbs that compare.
#pragma once

#include "audit/grade.h"
#include "console/exit_code.h"

namespace CLI {
class App;
}

namespace seedframe {

void add_tolerance_options(CLI::App& verb, Tolerance& tolerance);
ExitCode exit_code(Grade grade);

}  // namespace seedframe
