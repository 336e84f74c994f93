// What is fuzzed: each target reads bytes from anywhere as the program would read a file or a
// message, and keeps its promises whatever they are.
#pragma once

#include <string_view>

namespace seedframe {

/// The text of a campaign's config: read, compiled, its first frame expanded.
void fuzz_config(std::string_view bytes);
/// A frame spec as JSON.
void fuzz_frame_spec(std::string_view bytes);
/// A line of a worker.
void fuzz_protocol(std::string_view bytes);
/// A frame's manifest.json or labels.json.
void fuzz_job_manifest(std::string_view bytes);
/// The passes of a worker, or the depth of an export: OpenEXR.
void fuzz_exr_front(std::string_view bytes);
/// An asset's mesh: a Draco stream, or a mesh buffer.
void fuzz_draco_front(std::string_view bytes);
/// The materials of a mesh file (.mtl), or those that an asset.json keeps.
void fuzz_materials(std::string_view bytes);

}  // namespace seedframe
