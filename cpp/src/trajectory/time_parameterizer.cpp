#include "viapoint/trajectory/time_parameterizer.hpp"

#include <cmath>

#include "trajectory/path_timing_span.hpp"
#include "trajectory/path_timing_uniform.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

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
    if (!(piece.scale > 0.0 && piece.scale <= 1.0) || !(piece.rate_limit > 0.0) ||
        !(piece.rate_change_limit > 0.0)) {
      throw MotionError(
          ErrorCode::kBadArgument,
          "A path piece has a scale outside (0, 1] or a ceiling that is not positive.");
    }
  }
}

}  // namespace

std::vector<TrajectoryPiece> parameterize(const JointPath& path, const JointLimits& limits) {
  using namespace path_timing;
  require_valid(path, limits);
  constexpr double kProofSlack = 1e-4;
  if (const auto ceilings = straight_ceilings(path, limits)) {
    auto spans = seven_phases(path, *ceilings);
    fit_time(path, limits, spans, kProofSlack);
    return to_pieces(path, spans);
  }
  auto spans = seven_phases(path, uniform_ceilings(path, limits));
  fit_time(path, limits, spans, kProofSlack);
  return to_pieces(path, spans);
}

}  // namespace viapoint
