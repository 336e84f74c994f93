#include "base/pixel_rect.h"

#include <algorithm>

namespace seedframe {

PixelRect union_of(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.end_x(), b.end_x()) - x, std::max(a.end_y(), b.end_y()) - y};
}

}  // namespace seedframe
