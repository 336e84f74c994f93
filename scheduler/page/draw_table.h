// All draws of a campaign by name, and how often each value was to be expected.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "draws/draw_record.h"

namespace seedframe {

class DrawTable {
 public:
  /// The next frame's, in the order of frames; nothing where they are not known. The draws of an
  /// object's copies ("objects.bolts.count/3") are one variable with several values.
  void add(std::int64_t scene, const std::vector<Draw>& draws);

  /// A variable for each name, in the order of names. docs/report.md has the keys.
  Json to_json() const;

 private:
  /// Draws of the same law, counted.
  struct CountedLaw {
    DrawLaw law;
    std::int64_t draws = 0;
  };
  struct Variable {
    std::vector<std::uint32_t> counts;  ///< values of each frame so far
    std::vector<float> numbers;
    std::vector<std::string> names;  ///< instead of numbers
    bool has_law = true;
    Level level = Level::kFrame;
    DistributionKind kind = DistributionKind::kUniform;
    std::int64_t law_draws = 0;              ///< counted among the laws
    std::map<std::string, CountedLaw> laws;  ///< by their parameters
    std::int64_t last_scene = -1;            ///< whose draws are counted among the laws
    std::size_t last_frame = 0;
  };
  using ShareOf = std::function<std::optional<double>(const DrawLaw&)>;

  static Json expected(const Variable& variable, const ShareOf& share_of);
  static Json expected_between(const Variable& variable, double low, double high);
  static void add_names(const Variable& variable, Json& json);
  static void add_numbers(const Variable& variable, Json& json);
  void add(Variable& variable, std::int64_t scene, const Draw& draw);
  Json variable_json(const std::string& name, const Variable& variable) const;

  std::size_t frames_ = 0;
  std::map<std::string, Variable> variables_;
};

}  // namespace seedframe
