// Which frames train and which validate.
#pragma once

#include "export/dataset.h"
#include "export/exporter.h"

namespace seedframe {

enum class Split { kTrain, kVal };

/// "train" or "val".
const char* split_name(Split split);

/// A draw of the stream "export/split" keyed by the scene alone: frames of one scene, which look
/// alike, stay together, and adding frames or scenes moves no scene to the other split.
Split split_of_scene(int scene, const ExportOptions& options);

}  // namespace seedframe
