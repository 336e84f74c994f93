#include "assets/asset_check.h"

#include <cmath>

#include "assets/asset_files.h"
#include "assets/asset_level_file.h"
#include "base/files.h"
#include "base/sha256.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_measure.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

// Sums of the same numbers, but perhaps of another compiler.
constexpr double kRelative = 1e-6;
constexpr double kMicrometre = 1e-6;

class Checker {
 public:
  explicit Checker(const fs::path& folder) : folder_(folder) {}

  std::vector<std::string> run(const AssetCheck& check) {
    const auto description = read_asset_description(folder_);
    if (!description) return {description.error().message};
    std::vector<Mesh> meshes;
    for (std::size_t k = 0; k < description->levels.size(); ++k) {
      auto mesh = read_level_mesh(folder_, *description, k);
      if (!mesh) {
        faults_.push_back(mesh.error().message);
        meshes.emplace_back();
        continue;
      }
      compare_sizes(*mesh, description->levels[k]);
      meshes.push_back(std::move(*mesh));
    }
    for (const auto& [slot, material] : description->materials) check_files_of(material);
    if (meshes[0].triangles.empty()) return faults_;
    compare_measures(measure_mesh(meshes[0]), description->measures);
    for (std::size_t k = 1; k < meshes.size(); ++k) {
      if (meshes[k].triangles.empty()) continue;
      compare_distance(meshes[0], meshes[k], description->levels[k], check);
    }
    return faults_;
  }

 private:
  template <class T>
  void expect(const std::string& place, const char* key, const T& said, const T& found) {
    if (said == found) return;
    faults_.push_back(fmt::format("{}: {}: '{}' says {}, but it is {}", folder_.string(), place,
                                  key, said, found));
  }

  void expect_near(const char* key, double said, double found, double tolerance) {
    if (std::abs(said - found) <= tolerance) return;
    expect("measures", key, said, found);
  }

  void check_files_of(const AssetMaterial& material) {
    for (const auto& [role, file] : material.files) {
      const auto bytes = read_file(folder_ / file);
      if (!bytes) {
        faults_.push_back(bytes.error().message);
      } else if (sha256_hex(*bytes) != material.spec.textures.at(role)) {
        faults_.push_back(fmt::format("{} is damaged: its SHA-256 is not that of {}",
                                      (folder_ / file).string(), asset_files::kDescription));
      }
    }
  }

  void compare_sizes(const Mesh& mesh, const LevelRecord& level) {
    expect(level.file, "vertices", level.vertices, std::uint64_t{mesh.positions.size()});
    std::error_code error;
    expect(level.file, "bytes", level.bytes,
           std::uint64_t{fs::file_size(folder_ / level.file, error)});
  }

  void compare_measures(const MeshMeasures& found, const MeshMeasures& said) {
    for (int axis = 0; axis < 3; ++axis) {
      expect_near("size_m", said.box.size()[axis], found.box.size()[axis], kMicrometre);
    }
    expect_near("area_m2", said.area_m2, found.area_m2, kRelative * found.area_m2);
    expect("measures", "watertight", said.watertight, found.watertight);
    expect("measures", "boundary_edges", said.boundary_edges, found.boundary_edges);
    expect("measures", "bad_edges", said.bad_edges, found.bad_edges);
    expect("measures", "parts", said.parts, found.parts);
    expect("measures", "genus", said.genus.value_or(-1), found.genus.value_or(-1));
    const double cube = std::pow(found.size_m, 3.0);
    expect_near("volume_m3", said.volume_m3.value_or(0.0), found.volume_m3.value_or(0.0),
                kRelative * cube);
  }

  void compare_distance(const Mesh& finest, const Mesh& mesh, const LevelRecord& level,
                        const AssetCheck& check) {
    const std::string place = (folder_ / level.file).string();
    const auto distance = check.thorough
                              ? hausdorff_distance(finest, mesh, level.error_m / 16.0, place)
                              : sampled_distance(finest, mesh, place);
    if (!distance) {
      faults_.push_back(distance.error().message);
    } else if (distance->lower_m > level.error_m) {
      faults_.push_back(fmt::format("{}: 'error_m' says {:.4g}, but the surface is {:.4g} m off",
                                    place, level.error_m, distance->lower_m));
    }
    if (level.error_m > level.bound_m) {
      faults_.push_back(fmt::format("{}: 'error_m' ({:.4g}) is above 'bound_m' ({:.4g})", place,
                                    level.error_m, level.bound_m));
    }
  }

  fs::path folder_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> check_asset(const fs::path& folder, const AssetCheck& check) {
  return Checker(folder).run(check);
}

}  // namespace seedframe
