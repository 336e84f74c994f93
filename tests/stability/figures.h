// What was measured of each case.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "tests/stability/agreement.h"

namespace seedframe {

struct ErrorQuantiles {
  double median = 0.0, p99 = 0.0, most = 0.0;
};

struct AgreementFigures {
  std::int64_t pixels = 0;
  std::int64_t wrong = 0;
  ErrorQuantiles depth_ulp, normal_deg;
};

AgreementFigures figures_of(const Agreement& agreement);

/// Of one Blender.
struct BlenderFigures {
  std::string version;
  std::string failure;                      ///< why a frame was not rendered; empty: all were
  std::int64_t inside_px = 0, edge_px = 0;  ///< where it differs from the twin
  std::string complaint;                    ///< of the check, of the first frame that it refuses
  Judgement judgement;
  AgreementFigures agreement;
};

struct CaseFigures {
  std::string axis, name;
  std::optional<double> at;
  std::size_t frames = 0;
  std::int64_t asked = 0;       ///< pixels that CGAL decided
  std::int64_t twin_moved = 0;  ///< pixels of the twin that differ from those of the first case
  AgreementFigures twin;
  std::vector<BlenderFigures> blenders;
};

Json to_json(const CaseFigures& figures);

/// What to_json wrote; throws Json::exception for anything else.
CaseFigures case_figures_from_json(const Json& json);

}  // namespace seedframe
