#include "assets/asset_materials.h"
#include "base/canonical_json.h"
#include "base/utf8.h"
#include "mesh_files/mtl_reader.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {
namespace {

void fuzz_materials_of_an_asset(std::string_view bytes) {
  const auto json = parse_json(bytes, "asset.json");
  if (!json) return;
  const auto materials = materials_from_json(*json, "asset.json");
  if (!materials) {
    promise(materials.error().kind == ErrorKind::kCorrupt, "a damaged asset is one we wrote");
    return;
  }
  const std::string text = canonical_json(to_json(*materials));
  const auto again = materials_from_json(*parse_json(text, "asset.json"), "asset.json");
  promise(again.has_value(), "materials that were written can be read");
  promise(canonical_json(to_json(*again)) == text, "writing and reading change no materials");
}

void fuzz_mtl(std::string_view bytes) {
  static const MemoryFile file;
  file.write(bytes);
  MeshBuilder builder("part.obj");
  BesideFiles beside(file.path(), builder);
  for (const auto& [name, material] : read_mtl(file.path().filename(), beside, builder)) {
    promise(is_utf8(name), "names of materials are UTF-8");
    for (const double value :
         {material.base_color[0], material.base_color[1], material.base_color[2], material.metallic,
          material.roughness, material.clearcoat}) {
      promise(value >= 0.0 && value <= 1.0, "shares are from 0 to 1");
    }
    promise(material.ior >= 1.0 && material.ior <= 5.0, "indices of refraction are from 1 to 5");
  }
}

}  // namespace

void fuzz_materials(std::string_view bytes) {
  if (bytes.starts_with("{")) {
    fuzz_materials_of_an_asset(bytes);
  } else {
    fuzz_mtl(bytes);
  }
}

}  // namespace seedframe
