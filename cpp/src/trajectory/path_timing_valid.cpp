#include "trajectory/path_timing_valid.hpp"

#include <cmath>

#include "viapoint/core/error.hpp"

namespace viapoint::path_timing {

void require_valid(const JointPath& path, const JointLimits& limits) {
  limits.validate();
  if (path.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "A path without pieces has no timing.");
  }
  for (const JointPiece& piece : path.pieces()) {
    if (piece.joints() != limits.joints()) {
      throw MotionError(ErrorCode::kBadArgument, "The path and the limits differ in joints.");
    }
    if (!piece.coefficients.allFinite() || !std::isfinite(piece.length) || !(piece.length > 0.0)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "A path piece has coefficients or a length that are not finite.");
    }
    if (!(piece.coefficients.bottomRows<5>().norm() > 0.0)) {
      throw MotionError(ErrorCode::kBadArgument, "A path piece moves no joint.");
    }
    if (!(piece.scale > 0.0 && piece.scale <= 1.0)) {
      throw MotionError(ErrorCode::kBadArgument, "A path piece has a scale outside (0, 1].");
    }
  }
}

}  // namespace viapoint::path_timing
