#include "config/plan_sections.h"

#include <algorithm>
#include <set>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

constexpr std::int64_t kMostCombinations = 1'000'000;

std::variant<double, std::string> read_swept_value(const ConfigNode& node, Diagnostics& errors) {
  if (!node.is_scalar() || node.text().empty()) {
    errors.add(node.place(), "expected a number or a name, found " + node.description());
    return 0.0;
  }
  const NumberSource number = read_number(node, errors);
  if (const double* value = std::get_if<double>(&number.value)) return *value;
  return node.text();
}

SweepAxis read_axis(const std::string& name, const ConfigNode& node, Diagnostics& errors) {
  SweepAxis axis{name, node.place(), {}};
  if (!node.is_list() || node.items().empty()) {
    errors.add(node.place(), "expected a list of values, found " + node.description());
    return axis;
  }
  for (const ConfigNode& item : node.items()) {
    auto& point = axis.points.emplace_back();
    if (!item.is_map()) {
      point.emplace(name, read_swept_value(item, errors));
      continue;
    }
    if (item.entries().empty()) errors.add(item.place(), "expected at least one variable");
    for (const auto& [variable, value] : item.entries()) {
      if (!is_identifier(variable)) {
        errors.add(value.place(),
                   "a variable's name must be letters, digits and '_', and not "
                   "start with a digit");
      }
      point.emplace(variable, read_swept_value(value, errors));
    }
  }
  const auto& first = axis.points.front();
  const bool alike = std::all_of(axis.points.begin(), axis.points.end(), [&](const auto& point) {
    return point.size() == first.size() &&
           std::equal(point.begin(), point.end(), first.begin(), [](const auto& a, const auto& b) {
             return a.first == b.first && a.second.index() == b.second.index();
           });
  });
  if (!alike) {
    errors.add(node.place(),
               "every value of an axis must be of the same kind: all numbers, all "
               "names, or all mappings of the same variables");
  }
  return axis;
}

void collect_names(const std::vector<ObjectConfig>& objects, std::vector<std::string>& names) {
  for (const ObjectConfig& object : objects) {
    names.push_back(object.name);
    collect_names(object.objects, names);
  }
}

ConstraintKind read_kind(SectionReader& section) {
  static const std::vector<std::string> kinds = {"visible", "in_view", "pixels", "apart",
                                                 "distance"};
  const auto node = section.require("type");
  const std::string text = node && node->is_scalar() ? node->text() : "";
  const auto found = std::find(kinds.begin(), kinds.end(), text);
  if (found != kinds.end()) return static_cast<ConstraintKind>(found - kinds.begin());
  if (node) {
    section.errors().add(node->place(), "unknown type of constraint" + did_you_mean(text, kinds));
  }
  return ConstraintKind::kVisible;
}

double default_bound(ConstraintKind kind) {
  switch (kind) {
    case ConstraintKind::kVisible:
      return 0.5;
    case ConstraintKind::kInView:
    case ConstraintKind::kPixels:
      return 1.0;
    case ConstraintKind::kApart:
    case ConstraintKind::kDistance:
      return 0.0;
  }
  return 0.0;
}

}  // namespace

std::int64_t SweepConfig::size() const {
  std::int64_t size = 1;
  for (const SweepAxis& axis : axes) {
    size = std::min(size * static_cast<std::int64_t>(std::max<std::size_t>(axis.points.size(), 1)),
                    kMostCombinations + 1);
  }
  return size;
}

SweepConfig read_sweep(SectionReader& campaign) {
  SweepConfig sweep;
  const auto node = campaign.find("sweep");
  if (!node) return sweep;
  sweep.place = node->place();
  SectionReader section(*node, campaign.errors());
  sweep.hold_draws = section.flag("hold_draws", true);
  sweep.axes = read_named(section, "values", read_axis);
  std::set<std::string> seen;
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.points.empty()) continue;
    for (const auto& entry : axis.points.front()) {
      if (seen.insert(entry.first).second) continue;
      section.errors().add(axis.place, "the variable '" + entry.first + "' is swept twice");
    }
  }
  if (sweep.axes.empty()) section.errors().add(sweep.place, "the key 'values' is missing or empty");
  if (sweep.size() > kMostCombinations) {
    section.errors().add(sweep.place,
                         fmt::format("a sweep may have {} combinations", kMostCombinations));
  }
  section.refuse_other_keys();
  return sweep;
}

std::vector<ConstraintConfig> read_constraints(SectionReader& campaign,
                                               const std::vector<ObjectConfig>& objects) {
  std::vector<ConstraintConfig> constraints = read_named(
      campaign, "constraints",
      +[](const std::string& name, const ConfigNode& node, Diagnostics& errors) {
        ConstraintConfig constraint;
        constraint.name = name;
        constraint.place = node.place();
        SectionReader section(node, errors);
        constraint.kind = read_kind(section);
        constraint.objects = section.texts("objects");
        constraint.at_least = section.number("at_least", default_bound(constraint.kind));
        section.refuse_other_keys();
        return constraint;
      });
  std::vector<std::string> names;
  collect_names(objects, names);
  for (const ConstraintConfig& constraint : constraints) {
    for (const std::string& name : constraint.objects) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      campaign.errors().add(constraint.place,
                            "there is no object '" + name + "'" + did_you_mean(name, names));
    }
  }
  return constraints;
}

}  // namespace seedframe
