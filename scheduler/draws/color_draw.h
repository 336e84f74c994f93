// A colour of a config, in one of several models.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "draws/vector_draw.h"
#include "spec/frame_spec.h"

namespace seedframe {

class ColorDraw {
 public:
  static ColorDraw compile(const ColorSource& source, const CompileScope& scope,
                           const std::string& name, Level level, Diagnostics& errors);
  /// Linear Rec.709, none below 0.
  Rgb evaluate(EvaluationContext& context) const;

 private:
  ColorModel model_ = ColorModel::kRgb;
  std::array<NumberDraw, 3> components_;
  std::optional<VectorDraw> formula_;
  bool constant_ = false;
  Rgb value_{};  ///< when constant
};

}  // namespace seedframe
