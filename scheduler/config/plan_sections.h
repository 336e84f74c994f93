// The sections of a config that say which frames there are: sweep, constraints.
#pragma once

#include <vector>

#include "config/campaign_config.h"
#include "config/section_reader.h"

namespace seedframe {

SweepConfig read_sweep(SectionReader& campaign);
/// A constraint on an object that does not exist is an error.
std::vector<ConstraintConfig> read_constraints(SectionReader& campaign,
                                               const std::vector<ObjectConfig>& objects);

}  // namespace seedframe
