#include "config/settings.h"

namespace seedframe {

CampaignSettings settings_of(const CampaignConfig& config) {
  CampaignSettings settings;
  settings.name = config.name;
  settings.seed = config.seed;
  settings.scenes = config.scenes;
  settings.frames_per_scene = config.frames_per_scene;
  settings.categories = config.categories;
  settings.render.width = config.render.width;
  settings.render.height = config.render.height;
  settings.render.samples = config.render.samples;
  settings.render.adaptive = config.render.adaptive;
  settings.render.denoise = config.render.denoise;
  settings.render.max_bounces = config.render.max_bounces;
  settings.render.filter_width_px = config.render.filter_width_px;
  settings.render.clamp_indirect = config.render.clamp_indirect;
  settings.render.levers = config.render.levers;
  settings.render.region = config.render.region.box;
  settings.render.depth = config.render.depth;
  settings.render.normal = config.render.normal;
  settings.device = config.render.device;
  settings.persistent_data = config.render.persistent_data;
  settings.determinism = config.determinism;
  settings.image = config.image.settings;
  settings.image_encoding = config.image.encoding;
  settings.ocio_config = config.image.ocio_config;
  settings.image_place = config.image.place;
  settings.labels = config.labels.source;
  settings.twin_check = config.labels.check;
  settings.quality = config.quality;
  if (config.patches) settings.render.width = settings.render.height = config.patches->size;
  return settings;
}

}  // namespace seedframe
