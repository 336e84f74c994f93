// The sections of a config that describe what a scene holds: materials, objects, lights, ground,
// world, camera, sensor. Every reader reports what is wrong and returns something usable.
#pragma once

#include <vector>

#include "config/campaign_config.h"
#include "config/section_reader.h"

namespace seedframe {

std::vector<MaterialConfig> read_materials(SectionReader& campaign);
std::vector<ObjectConfig> read_objects(SectionReader& campaign);
std::vector<LightConfig> read_lights(SectionReader& campaign);
GroundConfig read_ground(const ConfigNode& node, Diagnostics& errors);
WorldConfig read_world(SectionReader& campaign);
CameraConfig read_camera(const ConfigNode& node, Diagnostics& errors);
SensorConfig read_sensor(const ConfigNode& node, Diagnostics& errors);

}  // namespace seedframe
