#include "assets/used_files.h"

namespace seedframe {

void UsedFiles::add(const UsedFiles& other) {
  assets.insert(other.assets.begin(), other.assets.end());
  images.insert(other.images.begin(), other.images.end());
}

}  // namespace seedframe
