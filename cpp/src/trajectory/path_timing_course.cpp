#include "trajectory/path_timing_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace viapoint::path_timing {
namespace {

/// |dq/du| at the ends of a piece.
double speed_at_start(const JointPiece& piece) { return piece.coefficients.row(1).norm(); }

double speed_at_end(const JointPiece& piece) {
  const auto row = [&](int k) { return piece.coefficients.row(k); };
  return (row(1) + 2.0 * row(2) + 3.0 * row(3) + 4.0 * row(4) + 5.0 * row(5)).norm();
}

}  // namespace

void Shares::include(const Shares& other) {
  // What is no number is no bound: infinity, which no maximum loses again.
  const auto raise = [](double& mine, double theirs) {
    mine = std::isnan(theirs) ? std::numeric_limits<double>::infinity() : std::max(mine, theirs);
  };
  raise(velocity, other.velocity);
  raise(acceleration, other.acceleration);
  raise(jerk, other.jerk);
}

double Shares::stretch() const {
  return std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
}

Course::Course(const JointPath& path, const JointLimits& limits, std::span<const ToolRates> tool)
    : joints_(limits.joints()),
      per_velocity_(limits.velocity.cwiseInverse()),
      per_acceleration_(limits.acceleration.cwiseInverse()),
      per_jerk_(limits.jerk.cwiseInverse()) {
  stretches_.reserve(path.pieces().size());
  // Pieces meet with equal q' by s, but for a factor where their scales of s differ.
  constexpr double kSameScale = 1e-9;
  double speed_before = 0.0, factor_before = 0.0;  // |dq/ds|, dσ/ds at the end of the piece before
  for (const JointPiece& piece : path.pieces()) {
    Stretch stretch;
    stretch.geometry = &piece;
    if (!tool.empty() && tool[stretches_.size()].limits.any()) {
      stretch.tool = &tool[stretches_.size()];
    }
    stretch.straight = stretch.tool == nullptr && !piece.coefficients.bottomRows<4>().any();
    const double start = speed_at_start(piece);
    const double end = stretch.straight ? start : speed_at_end(piece);
    const double chord = piece.coefficients.bottomRows<5>().colwise().sum().norm();
    stretch.length = std::max({start, end, chord});
    // One that comes back to where it began, at rest at both ends.
    if (!(stretch.length > 0.0)) stretch.length = piece.coefficients.bottomRows<5>().norm();
    const double factor = stretch.length / piece.length;
    if (stretch.straight) {
      const double per_scale = 1.0 / (stretch.length * piece.scale);
      const auto share = [&](const JointVector& per_limit) {
        double worst = 0.0;
        for (int i = 0; i < joints_; ++i) {
          worst = std::max(worst, std::abs(piece.coefficients(1, i)) * per_limit[i]);
        }
        return worst * per_scale;
      };
      stretch.rate_limit = 1.0 / share(per_velocity_);
      stretch.change_limit = 1.0 / share(per_acceleration_);
      stretch.jerk_limit = 1.0 / share(per_jerk_);
    }
    const double speed = start / piece.length;
    if (!stretches_.empty()) {
      const double ratio = speed > 0.0 && speed_before > 0.0 ? speed_before / speed : 1.0;
      stretch.gear = factor / factor_before;
      if (std::abs(ratio - 1.0) > kSameScale) stretch.gear *= ratio;
    }
    speed_before = end / piece.length;
    factor_before = factor;
    stretches_.push_back(stretch);
  }
}

JointPath Course::in_one_scale() const {
  JointPath path;
  double scale = 1.0;
  for (const Stretch& stretch : stretches_) {
    scale /= stretch.gear;
    JointPiece piece = *stretch.geometry;
    piece.length = scale * stretch.length;
    path.append(std::move(piece));
  }
  return path;
}

void Course::rates(size_t stretch, double sigma, JointRates& rates) const {
  const Stretch& here = stretches_[stretch];
  const auto& c = here.geometry->coefficients;
  const double u = sigma / here.length;
  const double once = 1.0 / here.length, twice = once * once, thrice = twice * once;
  const double per_scale = 1.0 / here.geometry->scale;
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    const double c2 = c(2, i), c3 = c(3, i), c4 = c(4, i), c5 = c(5, i);
    const double first = c(1, i) + u * (2 * c2 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)));
    const double second = 2 * c2 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5));
    const double third = 6 * c3 + u * (24 * c4 + u * 60 * c5);
    const double q1 = first * once * per_scale, q2 = second * twice * per_scale;
    rates.velocity[k] = q1 * per_velocity_[i];
    rates.acceleration1[k] = q1 * per_acceleration_[i];
    rates.acceleration2[k] = q2 * per_acceleration_[i];
    rates.jerk1[k] = q1 * per_jerk_[i];
    rates.jerk2[k] = q2 * per_jerk_[i];
    rates.jerk3[k] = third * thrice * per_scale * per_jerk_[i];
  }
}

}  // namespace viapoint::path_timing
