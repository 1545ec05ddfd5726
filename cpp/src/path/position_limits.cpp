#include "viapoint/path/position_limits.hpp"

#include <cmath>

#include "path/quintic_extrema.hpp"

namespace viapoint {
namespace {

/// How finely the farthest value beyond a limit is told [rad or m].
constexpr double kValueResolution = 1e-12;

/// Holds sign * polynomial <= sign * limit + slack, and keeps the earliest breach in `first`.
/// @return true when this is the earliest so far
bool hold(const Quintic& polynomial, double length, double sign, double limit, double slack,
          std::optional<LimitCrossing>& first) {
  if (!std::isfinite(limit)) return false;
  Quintic excess = polynomial;
  for (double& coefficient : excess) coefficient *= sign;
  excess[0] -= sign * limit + slack;
  const std::optional<double> crossed = first_positive(excess);
  if (!crossed || (first && first->s <= *crossed * length)) return false;
  LimitCrossing crossing;
  crossing.s = *crossed * length;
  crossing.limit = limit;
  crossing.value = limit + sign * (maximum(excess, kValueResolution) + slack);
  first = crossing;
  return true;
}

}  // namespace

double farthest_value(const JointPiece& piece, const JointLimits& limits,
                      const LimitCrossing& crossing) {
  Quintic polynomial{};
  const bool upper = crossing.joint >= 0
                         ? crossing.limit == limits.position_max[crossing.joint]
                         : crossing.limit == limits.coupling_upper[crossing.coupling];
  const double sign = upper ? 1.0 : -1.0;
  for (int k = 0; k < 6; ++k) {
    const double coefficient =
        crossing.joint >= 0 ? piece.coefficients(k, crossing.joint)
                            : piece.coefficients.row(k).dot(limits.coupling.row(crossing.coupling));
    polynomial[static_cast<size_t>(k)] = sign * coefficient;
  }
  return sign * maximum(polynomial, kValueResolution);
}

std::optional<LimitCrossing> piece_position_violation(const JointPiece& piece,
                                                      const JointLimits& limits, double slack) {
  std::optional<LimitCrossing> first;
  Quintic polynomial{};
  for (int i = 0; i < piece.joints(); ++i) {
    for (int k = 0; k < 6; ++k) polynomial[static_cast<size_t>(k)] = piece.coefficients(k, i);
    if (hold(polynomial, piece.length, 1.0, limits.position_max[i], slack, first) |
        hold(polynomial, piece.length, -1.0, limits.position_min[i], slack, first)) {
      first->joint = i;
    }
  }
  for (int row = 0; row < limits.couplings(); ++row) {
    for (int k = 0; k < 6; ++k) {
      polynomial[static_cast<size_t>(k)] = piece.coefficients.row(k).dot(limits.coupling.row(row));
    }
    if (hold(polynomial, piece.length, 1.0, limits.coupling_upper[row], slack, first) |
        hold(polynomial, piece.length, -1.0, limits.coupling_lower[row], slack, first)) {
      first->coupling = row;
    }
  }
  return first;
}

}  // namespace viapoint
