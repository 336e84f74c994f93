#include <algorithm>
#include <array>
#include <utility>

#include "base/nearest_name.h"
#include "config/scene_sections.h"

namespace seedframe {
namespace {

MaterialConfig read_material(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  MaterialConfig material;
  material.name = name;
  material.place = node.place();
  SectionReader section(node, errors);
  material.base_color = section.color("base_color", {0.8, 0.8, 0.8});
  if (const auto textures = section.find("textures")) {
    material.textures = read_name(*textures, errors);
    if (!node.find("base_color")) {
      for (NumberSource& c : material.base_color.components) c = number_constant(1.0);
    }
  }
  material.metallic = section.number("metallic", 0.0);
  material.roughness = section.number("roughness", 0.5);
  material.specular = section.number("specular", 0.5);
  material.transmission = section.number("transmission", 0.0);
  material.ior = section.number("ior", 1.45);
  material.clearcoat = section.number("clearcoat", 0.0);
  material.texture_repeat = section.number("texture_repeat", 1.0);
  material.texture_size_m = section.optional_number("texture_size_m");
  if (material.texture_size_m && node.find("texture_repeat")) {
    errors.add(node.find("texture_repeat")->place(),
               "texture_repeat and texture_size_m say the same in two ways: remove one");
  }
  section.refuse_other_keys();
  return material;
}

ScatterConfig read_scatter(const ConfigNode& node, Diagnostics& errors) {
  ScatterConfig scatter;
  scatter.place = node.place();
  SectionReader section(node, errors);
  const auto range = [&](const char* key, std::array<NumberSource, 2>& ends) {
    const auto found = section.require(key);
    if (!found) return;
    const auto items = found->items();
    if (items.size() != 2) {
      errors.add(found->place(), "expected [least, most], found " + found->description());
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) ends[i] = read_number(items[i], errors);
  };
  range("x", scatter.x);
  range("y", scatter.y);
  scatter.gap_m = section.number("gap_m", 0.0);
  scatter.pile = section.flag("pile", false);
  if (scatter.pile && node.find("gap_m")) {
    errors.add(node.find("gap_m")->place(),
               "what is piled keeps no gap_m from the others: remove gap_m or pile");
  }
  section.refuse_other_keys();
  return scatter;
}

/// A name or a choice, `own`, or for each asset its category.
void read_category(SectionReader& section, ObjectConfig& object) {
  const auto node = section.find("category");
  if (!node || (node->is_scalar() && node->text() == "own")) return;
  if (!node->is_map() || node->find("choice")) {
    object.category = read_name(*node, section.errors());
    return;
  }
  for (const auto& [asset, category] : node->entries()) {
    if (category.is_scalar() && !category.text().empty()) {
      object.category_of_asset[asset] = {category.text(), category.place()};
    } else {
      section.errors().add(category.place(),
                           "expected a category, found " + category.description());
    }
  }
}

/// Besides rotation_deg: any rotation, or that of a quaternion.
void read_rotation(SectionReader& section, ObjectConfig& object) {
  const auto node = section.find("rotation");
  if (!node) return;
  if (const auto angles = section.node().find("rotation_deg")) {
    section.errors().add(angles->place(), "rotation and rotation_deg exclude each other");
  }
  object.random_rotation = node->is_scalar() && node->text() == "random";
  if (object.random_rotation) return;
  if (!node->is_map()) {
    section.errors().add(node->place(), "expected random, or {quaternion: [w, x, y, z]}, found " +
                                            node->description() +
                                            "; angles are rotation_deg: [x, y, z]");
    return;
  }
  SectionReader inner(*node, section.errors());
  const auto quaternion = inner.require("quaternion");
  inner.refuse_other_keys();
  if (!quaternion) return;
  const std::vector<ConfigNode> items = quaternion->items();
  if (items.size() != 4) {
    section.errors().add(quaternion->place(),
                         "expected [w, x, y, z], found " + quaternion->description());
    return;
  }
  object.quaternion.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    (*object.quaternion)[i] = read_number(items[i], section.errors());
  }
}

bool read_rest(SectionReader& section) {
  const auto node = section.find("rest");
  if (!node) return false;
  if (!node->is_scalar() || node->text() != "stable") {
    section.errors().add(node->place(), "expected stable, found " + node->description());
  }
  for (const char* key : {"rest_on_ground", "rotation"}) {
    if (const auto other = section.node().find(key)) {
      section.errors().add(
          other->place(),
          fmt::format("rest and {} exclude each other{}", key,
                      std::string(key) == "rotation" ? ": rotation_deg turns what rests" : ""));
    }
  }
  return true;
}

HiddenFrom read_hidden_from(SectionReader& section) {
  static const std::vector<std::string> names = {"camera", "diffuse", "glossy", "transmission",
                                                 "shadow"};
  HiddenFrom hidden;
  const std::array<bool*, 5> flags = {&hidden.camera, &hidden.diffuse, &hidden.glossy,
                                      &hidden.transmission, &hidden.shadow};
  for (const std::string& text : section.texts("hidden_from")) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) {
      section.errors().add(section.node().find("hidden_from")->place(),
                           "unknown kind of ray '" + text + "'" + did_you_mean(text, names));
    } else {
      *flags[static_cast<std::size_t>(found - names.begin())] = true;
    }
  }
  return hidden;
}

/// One number for all axes, or one for each.
VectorSource read_scale(SectionReader& section) {
  const auto node = section.find("scale");
  if (node && node->is_list()) return read_vector(*node, section.errors());
  VectorSource scale;
  scale.alike = true;
  scale.components[0] = node ? read_number(*node, section.errors()) : number_constant(1.0);
  return scale;
}

ObjectConfig read_object(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  ObjectConfig object;
  object.name = name;
  object.place = node.place();
  SectionReader section(node, errors);
  object.variables = section.variables("variables");
  object.redraw = section.redraw(Level::kScene);
  object.grid = section.grid();
  object.count = section.number("count", 1.0);
  if (object.grid && node.find("count")) {
    errors.add(node.find("count")->place(), "count and grid exclude each other");
  }
  if (const auto asset = section.find("asset")) object.asset = read_name(*asset, errors);
  read_category(section, object);
  const auto material = node.find("material");
  object.has_material = material.has_value();
  object.material_of_parent = material && material->is_scalar() && material->text() == "parent";
  object.material = section.material("material");
  if (const auto slots = section.find("slots")) {
    if (!slots->is_map() && !slots->is_null()) {
      errors.add(slots->place(),
                 "expected a mapping of material slots, found " + slots->description());
    }
    for (const auto& [slot, source] : slots->entries()) {
      object.slots.emplace(slot, read_material_source(source, errors));
    }
  }
  object.scale = read_scale(section);
  object.rotation_deg = section.vector("rotation_deg", {0, 0, 0});
  read_rotation(section, object);
  object.position = section.vector("position", {0, 0, 0});
  if (const auto scatter = section.find("scatter")) {
    object.scatter = read_scatter(*scatter, errors);
  }
  object.rest_on_ground = section.flag("rest_on_ground", false);
  object.rest_stable = read_rest(section);
  object.hidden_from = read_hidden_from(section);
  const std::string detail = section.text("detail", "full");
  object.auto_detail = detail == "auto";
  if (detail != "auto" && detail != "full") {
    errors.add(node.find("detail")->place(),
               "expected 'full' or 'auto', found " + node.find("detail")->description());
  }
  object.objects = read_objects(section);
  if (!object.asset && object.objects.empty() && !node.find("objects")) {
    errors.add(node.place(),
               "the key 'asset' is missing (only a group, with 'objects' of its own, "
               "needs none)");
  }
  for (const char* key : {"category", "slots", "hidden_from", "detail", "rest"}) {
    if (object.asset || !node.find(key)) continue;
    errors.add(node.find(key)->place(), fmt::format("{} belongs to an asset, and this group has "
                                                    "none",
                                                    key));
  }
  if (object.scatter && object.grid) {
    errors.add(node.find("grid")->place(), "scatter and grid exclude each other");
  }
  if (object.scatter && object.scatter->pile && (!object.asset || !object.objects.empty())) {
    errors.add(object.scatter->place, "pile is for an asset without objects of its own");
  }
  if (object.scatter && object.scatter->pile && !object.rest_on_ground && !object.rest_stable) {
    errors.add(object.scatter->place,
               "what is piled falls until it rests: add rest_on_ground: true or rest: stable");
  }
  section.refuse_other_keys();
  return object;
}

}  // namespace

std::vector<MaterialConfig> read_materials(SectionReader& campaign) {
  std::vector<MaterialConfig> materials;
  const auto node = campaign.find("materials");
  if (!node) return materials;
  if (!node->is_map() && !node->is_null()) {
    campaign.errors().add(node->place(), "expected a mapping, found " + node->description());
  }
  for (const auto& [name, body] : node->entries()) {
    materials.push_back(read_material(name, body, campaign.errors()));
  }
  return materials;
}

std::vector<ObjectConfig> read_objects(SectionReader& section) {
  return read_named(section, "objects", read_object);
}

}  // namespace seedframe
