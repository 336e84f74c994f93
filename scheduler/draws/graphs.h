// Explicit graphs: JSON lines, each with the values of variables of one scene
// (docs/formats/graphs.md).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "draws/variables.h"

namespace seedframe {

/// What one graph gives, for EvaluationContext::given. kInput errors begin with `where`: not an
/// object, an unknown variable (with "did you mean"), a wrong type.
Result<std::vector<GivenValues>> read_graph(const Json& graph, const GraphVariables& variables,
                                            const std::string& where);

class Graphs {
 public:
  /// Errors (kInput): no such file, no lines.
  static Result<Graphs> open(const std::filesystem::path& file);

  /// Number of lines that are not empty.
  std::int64_t size() const { return static_cast<std::int64_t>(lines_.size()); }

  /// What line `index` gives; errors (kInput) name the file and the line.
  Result<std::vector<GivenValues>> read(std::int64_t index, const GraphVariables& variables) const;

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
