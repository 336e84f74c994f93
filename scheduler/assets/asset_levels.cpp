#include "assets/asset_levels.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/mesh_distance.h"
#include "mesh/mesh_simplify.h"
#include "mesh_files/draco_codec.h"

namespace seedframe {
namespace {

constexpr int kLeastBits = 10;
constexpr int kMostBits = 30;
constexpr int kBitsOfLevel0 = 16;  // as it has always been: a finer quantisation only on demand

// Fewest bits whose rounding, half a step along each axis, moves no point by more than `share` of
// the longest side.
int position_bits(double share, int least) {
  int bits = least;
  while (bits < kMostBits && std::sqrt(3.0) / 2.0 / (std::exp2(bits) - 1.0) > share) ++bits;
  return bits;
}

double longest_side(const Mesh& mesh) { return bounding_box(mesh).size().maxCoeff(); }

Status compress(const Mesh& mesh, StoredLevel& level, const std::string& what) {
  auto stream = encode_draco(mesh, {.position_bits = level.position_bits});
  if (!stream) return forward_error(stream);
  auto decoded = decode_draco(*stream, what + ", compressed");
  if (!decoded) return fail(ErrorKind::kInput, "{}", decoded.error().message);
  level.stream = std::move(*stream);
  level.mesh = std::move(*decoded);
  level.mesh.slot_names = mesh.slot_names;
  level.mesh.smooth_angle_rad = mesh.smooth_angle_rad;
  return {};
}

Result<StoredLevel> make_level_0(const Mesh& mesh, const LevelOptions& options,
                                 const std::string& what) {
  StoredLevel level;
  level.pixels = options.pixels;
  level.bound_m = longest_side(mesh) * kPixelShare / options.pixels;
  level.position_bits = position_bits(kPixelShare / options.pixels, kBitsOfLevel0);
  if (Status status = compress(mesh, level, what); !status) return forward_error(status);
  const auto distance = hausdorff_distance(mesh, level.mesh, level.bound_m / 16.0, what);
  if (!distance) return forward_error(distance);
  level.error_m = distance->upper_m + options.rounding_m;
  if (level.error_m <= level.bound_m) return level;
  return fail(ErrorKind::kInput,
              "{}: stored, the surface is {:.3g} m off, more than the {:.3g} m that --pixels {:g} "
              "asks for: lower --pixels",
              what, level.error_m, level.bound_m, options.pixels);
}

// One coarser level; nothing if it saves too little or no try stays within the bound.
class LevelMaker {
 public:
  LevelMaker(const StoredLevel& finest, MeshSimplifier simplifier, std::string what)
      : finest_(finest), simplifier_(std::move(simplifier)), what_(std::move(what)) {}

  Result<std::optional<StoredLevel>> make(double pixels, std::size_t triangles_before) {
    StoredLevel level;
    level.pixels = pixels;
    level.bound_m = longest_side(finest_.mesh) * kPixelShare / pixels;
    level.position_bits = position_bits(kQuantisationShare * kPixelShare / pixels, kLeastBits);
    const double allowed = level.bound_m - finest_.error_m;
    double tolerance = kFirstTolerance * allowed;
    const auto most =
        static_cast<std::size_t>((1.0 - kLeastSaving) * static_cast<double>(triangles_before));
    for (int attempt = 0; attempt < kMostAttempts && tolerance > 0.0; ++attempt) {
      MeshSimplifier tried = simplifier_;
      if (Status status = tried.simplify(tolerance); !status) return forward_error(status);
      if (tried.triangle_count() > most) break;  // a smaller tolerance would save even less
      const Mesh mesh = tried.mesh();
      if (!check_mesh(mesh, what_)) break;
      if (Status status = compress(mesh, level, what_); !status) return forward_error(status);
      const auto distance =
          hausdorff_distance(finest_.mesh, level.mesh, level.bound_m / 16.0, what_);
      if (!distance) return forward_error(distance);
      level.error_m = distance->upper_m;
      if (level.error_m <= allowed) {
        simplifier_ = std::move(tried);
        return std::optional(std::move(level));
      }
      tolerance *= std::min(0.9, 0.9 * allowed / level.error_m);
    }
    return std::optional<StoredLevel>();
  }

 private:
  // The simplifier looks at points; what lies between them is up to 1.6 times as far off.
  static constexpr double kFirstTolerance = 0.65;
  static constexpr double kQuantisationShare = 0.1;
  static constexpr int kMostAttempts = 4;

  const StoredLevel& finest_;
  MeshSimplifier simplifier_;
  std::string what_;
};

}  // namespace

Result<std::vector<StoredLevel>> make_levels(const Mesh& mesh, const LevelOptions& options,
                                             const std::string& what) {
  const auto begin = [&](const std::string& step) {
    if (options.on_step) options.on_step(step);
  };
  std::vector<StoredLevel> levels;
  begin("compressing it and measuring the error");
  levels.reserve(1 + static_cast<std::size_t>(std::max(0, options.most_levels)));
  auto finest = make_level_0(mesh, options, what);
  if (!finest) return forward_error(finest);
  levels.push_back(std::move(*finest));
  if (options.most_levels <= 0 || mesh.triangles.size() > kMostSimplifiedTriangles) return levels;
  begin("preparing coarser levels");
  auto simplifier = MeshSimplifier::create(levels.front().mesh, what);
  // Compression can weld what was apart by less than a step: such a mesh has one level only.
  if (!simplifier) return levels;
  LevelMaker maker(levels.front(), std::move(*simplifier), what);
  double pixels = options.pixels;
  for (int k = 1; k <= options.most_levels; ++k) {
    pixels /= 4.0;
    begin(fmt::format("level {} of {}", k, options.most_levels));
    auto level = maker.make(pixels, levels.back().mesh.triangles.size());
    if (!level) return forward_error(level);
    if (*level) levels.push_back(std::move(**level));
  }
  return levels;
}

}  // namespace seedframe
