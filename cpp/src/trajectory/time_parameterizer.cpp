#include "viapoint/trajectory/time_parameterizer.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory/path_timing_barrier.hpp"
#include "trajectory/path_timing_grid.hpp"
#include "trajectory/path_timing_range.hpp"
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

using path_timing::BarrierProblem;
using path_timing::Shares;
using path_timing::SquareRate;
using path_timing::TimedSpan;

/// How much of what is proven may be slack, relative.
constexpr double kProofSlack = 1e-4;
/// A hair more than the bound, against the rounding of whoever checks the result.
constexpr double kMargin = 1.0 + 1e-12;

/// What the limits of each cell must be multiplied by for the motion, as proven, to use as much of
/// them as the optimiser meant to.
std::vector<Shares> corrections(const std::vector<Shares>& meant, const JointPath& path,
                                const JointLimits& limits, const std::vector<TimedSpan>& spans) {
  constexpr int kCells = 4;
  constexpr double kOfInterest = 0.9, kLeast = 0.3, kMost = 1.1;
  const auto factor = [=](double model, double real) {
    const bool counts = real >= kOfInterest && model >= 0.5 * kOfInterest;
    return counts ? std::clamp(model / real, kLeast, kMost) : 1.0;
  };
  std::vector<Shares> factors;
  for (size_t k = 0; k < spans.size(); ++k) {
    const Shares real =
        bound_shares(path.pieces()[spans[k].piece], limits, spans[k], kCells).proven;
    factors.push_back({factor(meant[k].velocity, real.velocity),
                       factor(meant[k].acceleration, real.acceleration),
                       factor(meant[k].jerk, real.jerk)});
  }
  return factors;
}

/// The near-optimal timing, proven; empty if the method does not get there.
std::vector<TimedSpan> quickest(const JointPath& path, const JointLimits& limits) {
  constexpr int kPasses = 2, kMostPasses = 5;
  constexpr double kGoodEnough = 1.02;
  constexpr double kFirstWeight = 0.1, kRoughWeight = 0.01, kLastWeight = 1e-3;
  const path_timing::Grid grid = path_timing::make_grid(path, limits);
  if (grid.cells.empty()) return {};
  BarrierProblem problem(path, limits, grid);
  SquareRate rate = problem.start();
  if (!problem.solve(rate, kFirstWeight, kRoughWeight)) return {};
  // The optimiser sees limits at a few places of a cell and b as a cubic in s; the motion is a
  // quintic in time and held to its limits everywhere. Where the two differ, the limits given to
  // the optimiser are corrected.
  // Where that is not enough after the usual number of passes, a few more follow.
  for (int pass = 1;; ++pass) {
    problem.scale_limits(corrections(problem.shares(rate), path, limits, problem.spans(rate)));
    problem.make_feasible(rate, 0);
    const double last = pass >= kPasses ? kLastWeight : 0.4 * kRoughWeight;
    if (!problem.solve(rate, kRoughWeight, last)) return {};
    if (pass < kPasses) continue;
    std::vector<TimedSpan> spans = problem.spans(rate);
    const bool forward = std::all_of(spans.begin(), spans.end(), path_timing::goes_forward);
    if (!forward && pass >= kMostPasses) return {};
    if (!forward) continue;
    const double stretch = prove(path, limits, spans, kProofSlack).stretch();
    if (stretch > kGoodEnough && pass < kMostPasses) continue;
    stretch_time(spans, stretch * kMargin);
    return spans;
  }
}

}  // namespace

std::vector<TrajectoryPiece> parameterize(const JointPath& path, const JointLimits& limits) {
  using namespace path_timing;
  require_valid(path, limits);
  if (const auto ceilings = path_timing::straight_ceilings(path, limits)) {
    auto spans = seven_phases(path, within_range(*ceilings, path, limits));
    stretch_time(spans, prove(path, limits, spans, kProofSlack).stretch() * kMargin);
    return to_pieces(path, spans);
  }
  // The ceilings are bounds already, so proof can only shorten what they give.
  auto spans = seven_phases(path, within_range(uniform_ceilings(path, limits), path, limits));
  stretch_time(spans, std::min(1.0, kMargin * prove(path, limits, spans, kProofSlack).stretch()));
  auto quick = quickest(path, limits);
  if (!quick.empty() && total_duration(quick) < total_duration(spans)) spans = std::move(quick);
  return to_pieces(path, spans);
}

}  // namespace viapoint
