// Explicit graphs: JSON lines, each with the values of variables of one scene
// (docs/formats/graphs.md).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "draws/variables.h"
#include "spec/rendering_wish.h"

namespace seedframe {

/// What one line says.
struct Graph {
  std::vector<GivenValues> values;     ///< for EvaluationContext::given
  std::optional<std::uint32_t> scene;  ///< whose draws are made for what is left out; none: its own
  RenderingWish rendering;
};

/// Values alone. kInput errors begin with `where`: not an object, an unknown variable (with "did
/// you mean"), a wrong type.
Result<std::vector<GivenValues>> read_values(const Json& values, const GraphVariables& variables,
                                             const std::string& where);

/// A line that gives these values for this scene, and wishes this.
std::string graph_line(const Json& values, std::int64_t scene, const RenderingWish& rendering);

/// Limits of a file.
inline constexpr std::size_t kMostGraphBytes = 1u << 30;
inline constexpr std::size_t kMostGraphs = 10'000'000;

class Graphs {
 public:
  enum class Kind {
    kWhole,
    kGrowing,  ///< may have no lines yet; what has no line feed yet is not one
  };
  /// Errors (kInput): no such file, no lines.
  static Result<Graphs> open(const std::filesystem::path& file, Kind kind = Kind::kWhole);

  /// Number of lines that are not empty.
  std::int64_t size() const { return static_cast<std::int64_t>(lines_.size()); }

  /// What line `index` says; errors (kInput) name the file and the line.
  Result<Graph> read(std::int64_t index, const GraphVariables& variables) const;

 private:
  struct Line {
    std::size_t begin = 0;
    std::size_t length = 0;
    std::size_t number = 0;  ///< in the file, from 1
  };
  std::string file_;
  std::shared_ptr<const std::string> text_;
  std::vector<Line> lines_;
};

}  // namespace seedframe
