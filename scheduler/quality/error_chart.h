// Error over run time, drawn.
#pragma once

#include <string>
#include <vector>

#include "plot/chart.h"
#include "quality/choice.h"

namespace seedframe {

/// Both axes logarithmic; a series for each lever, plain samples joined and their numbers beside
/// them, and the front as a broken line. `relative`: to 16 plain samples (choices_overall).
Chart error_chart(const std::string& title, const std::vector<Choice>& choices,
                  const Measure& measure, bool relative);

}  // namespace seedframe
