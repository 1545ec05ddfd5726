#include "planning/path_cut.hpp"

#include <algorithm>
#include <utility>

namespace viapoint::planning {

JointPath cut(const JointPath& path, double s0, double s1, double scale) {
  JointPath result;
  // A sliver shorter than this is rounding, not geometry; it would only stiffen the timing.
  const double sliver = 1e-12 * path.length();
  for (size_t i = 0; i < path.pieces().size(); ++i) {
    const JointPiece& whole = path.pieces()[i];
    const double begin = std::max(0.0, s0 - path.start_of(i));
    const double end = std::min(whole.length, s1 - path.start_of(i));
    if (end - begin <= sliver) continue;
    JointPiece piece = begin <= 0.0 && end >= whole.length ? whole : whole.part(begin, end);
    piece.length *= scale;
    result.append(std::move(piece));
  }
  return result;
}

}  // namespace viapoint::planning
