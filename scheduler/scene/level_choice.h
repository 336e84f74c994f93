// Which level of detail of an asset is enough for a view.
#pragma once

#include <cstddef>

#include "assets/asset_library.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// The coarsest level whose surface is seen within 1/20 pixel of where that of the imported mesh is
/// seen, wherever on the instance; 0 if only the mesh itself is, as when the camera is near it.
std::size_t level_of_detail(const Asset& asset, const Affine& camera_from_object,
                            const CameraSpec& camera);

}  // namespace seedframe
