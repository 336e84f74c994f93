#include "scene/expansion_summary.h"

#include <algorithm>

#include <fmt/format.h>

namespace seedframe {

void ExpansionSummary::add(const ExpandedFrame& frame) {
  ++frames;
  least_instances = std::min(least_instances, frame.spec.instances.size());
  most_instances = std::max(most_instances, frame.spec.instances.size());
  attempts += frame.attempts;
  const RenderSettings& render = frame.spec.render;
  image_px += std::int64_t{render.width} * render.height;
  rendered_px += render.rendered_pixels().area();
  used.add(frame.used);
  for (const InstanceSpec& instance : frame.spec.instances) {
    if (!instance.asset.empty()) meshes.insert(instance.mesh);
  }
  constraints.resize(frame.constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    constraints[i].checked += frame.constraints[i].checked;
    constraints[i].met += frame.constraints[i].met;
  }
}

Result<ExpansionSummary> expand_all(const SceneExpander& expander, const ExpansionWishes& wishes,
                                    const std::function<Status(const ExpandedFrame&)>& visit) {
  ExpansionSummary summary;
  for (std::int64_t frame = 0; frame < expander.frame_count(); ++frame) {
    const Result<ExpandedFrame> expanded = expander.expand(frame, wishes);
    if (!expanded) return forward_error(expanded);
    summary.add(*expanded);
    if (!visit) continue;
    if (Status visited = visit(*expanded); !visited) return forward_error(visited);
  }
  return summary;
}

std::string describe_constraints(const SceneExpander& expander,
                                 const std::vector<ConstraintTally>& tallies) {
  const std::vector<std::string> names = expander.constraint_names();
  std::string text;
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    text += fmt::format("constraint {}: met in {} of {} draws\n", names[i], tallies[i].met,
                        tallies[i].checked);
  }
  return text;
}

}  // namespace seedframe
