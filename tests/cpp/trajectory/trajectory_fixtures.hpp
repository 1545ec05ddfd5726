/// @file
/// Pieces and limits that the tests of this module are made of.
#pragma once

#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::testing {

inline constexpr std::array<double, 6> kSteady = {0, 1, 0, 0, 0, 0};
/// 0 to 1 with no speed and no acceleration at either end (minimum jerk, Flash & Hogan 1985).
inline constexpr std::array<double, 6> kSmoothStep = {0, 0, 0, 10, -15, 6};

/// The same limits for each of `joints` joints, positions within ±position.
inline JointLimits uniform_limits(int joints, double position, double velocity, double acceleration,
                                  double jerk) {
  const auto all = [&](double value) { return JointVector(JointVector::Constant(joints, value)); };
  JointLimits limits;
  limits.position_min = all(-position);
  limits.position_max = all(position);
  limits.velocity = all(velocity);
  limits.acceleration = all(acceleration);
  limits.jerk = all(jerk);
  return limits;
}

/// A piece of one joint.
inline TrajectoryPiece one_joint_piece(double duration, const std::array<double, 6>& path,
                                       const std::array<double, 6>& timing = kSteady) {
  TrajectoryPiece piece;
  piece.duration = duration;
  piece.joints = 1;
  for (std::size_t k = 0; k < 6; ++k) piece.path[k][0] = path[k];
  piece.timing = timing;
  return piece;
}

/// From `from` to `to` in `duration` s, at rest at both ends.
inline TrajectoryPiece smooth_move(double from, double to, double duration) {
  return one_joint_piece(duration, {from, to - from, 0, 0, 0, 0}, kSmoothStep);
}

/// Monomial coefficients of the polynomial with the given Bernstein coefficients, degree 5 at most.
inline std::array<double, 6> monomials_of(const std::vector<double>& bernstein) {
  constexpr std::array<std::array<double, 6>, 6> kBinomial = {{{1, 0, 0, 0, 0, 0},
                                                               {1, 1, 0, 0, 0, 0},
                                                               {1, 2, 1, 0, 0, 0},
                                                               {1, 3, 3, 1, 0, 0},
                                                               {1, 4, 6, 4, 1, 0},
                                                               {1, 5, 10, 10, 5, 1}}};
  const std::size_t degree = bernstein.size() - 1;
  std::array<double, 6> monomials{};
  for (std::size_t j = 0; j <= degree; ++j) {
    double difference = 0.0;
    for (std::size_t i = 0; i <= j; ++i) {
      difference += ((j - i) % 2 == 0 ? 1.0 : -1.0) * kBinomial[j][i] * bernstein[i];
    }
    monomials[j] = kBinomial[degree][j] * difference;
  }
  return monomials;
}

/// Any piece whose u stays within [0, 1]: random degrees of path and timing, u not always rising.
inline TrajectoryPiece random_piece(std::mt19937_64& random, int joints) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::uniform_real_distribution<double> signed_unit(-1.0, 1.0);
  std::uniform_int_distribution<std::size_t> degree(1, 5);

  TrajectoryPiece piece;
  piece.joints = joints;
  piece.duration = 0.01 + unit(random);
  std::vector<double> u(degree(random) + 1);
  for (double& b : u) b = unit(random);
  piece.timing = monomials_of(u);
  const std::size_t path_degree = degree(random);
  for (std::size_t k = 0; k <= path_degree; ++k) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
      piece.path[k][i] = signed_unit(random);
    }
  }
  return piece;
}

}  // namespace viapoint::testing
