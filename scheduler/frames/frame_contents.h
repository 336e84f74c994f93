// Whether the files of a committed frame hold what follows from each other: a file may have been
// changed together with its entry in the manifest.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "frames/manifest.h"
#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"
#include "twin/twin.h"

namespace seedframe {

/// How a frame's files are compared with its spec.
struct ContentWish {
  const std::vector<std::string>& categories;
  /// Of the spec's instances; null: the labels are not made again.
  const MeshBuffers* meshes = nullptr;
  /// Whether the labels were made by rays like ours, whose last bits depend on the CPU: only then
  /// silhouettes, and what follows from them, are compared.
  bool same_rays = true;
};

/// Complaints, each about a file by its name; none when all is as it follows. From the spec follows
/// frame.json; from it and instances.png semantic.png and labels.json; by the pixel hashes of the
/// manifest are known instances.png, depth.exr, normal.exr, passes.exr, and the picture unless its
/// encoding loses something. What the manifest does not list is named, too. Thread-safe.
std::vector<std::string> wrong_contents(const std::filesystem::path& folder,
                                        const Manifest& manifest, const FrameSpec& spec,
                                        const ContentWish& wish, TwinTracer& tracer);

}  // namespace seedframe
