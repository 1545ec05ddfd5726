#include "planning/tool_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint::planning {
namespace {

/// Suprema over a piece, by s.
struct ToolRates {
  double first = 0.0;    ///< ‖p'‖
  double second = 0.0;   ///< ‖p''‖
  double fastest = 0.0;  ///< of ds/dt under the joints' velocity limits
};

/// sup |q'''| over the piece: its polynomial in u has coefficients 6, 24, 60.
JointVector third_bound(const JointPiece& piece) {
  const JointVector third = 6.0 * piece.coefficients.row(3).cwiseAbs().transpose() +
                            24.0 * piece.coefficients.row(4).cwiseAbs().transpose() +
                            60.0 * piece.coefficients.row(5).cwiseAbs().transpose();
  return third / (piece.length * piece.length * piece.length);
}

/// The farthest any axis can be from the tool point; 1 where a joint slides.
double lever_bound(const ForwardKinematics& arm, const JointPiece& piece) {
  JointVector travel(piece.joints());
  for (Eigen::Index i = 0; i < travel.size(); ++i) {
    travel[i] = piece.coefficients.col(i).cwiseAbs().sum();
  }
  double lever = arm.reach_bound(travel).maxCoeff();
  for (int i = 0; i < arm.joints(); ++i) {
    if (arm.type(i) == JointType::kPrismatic) lever = std::max(lever, 1.0);
  }
  return lever;
}

/// The largest ds/dt that the velocity limits allow where |q'| >= least.
double fastest_rate(const JointVector& least, const JointVector& velocity) {
  double rate = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < least.size(); ++i) {
    if (least[i] > 0.0) rate = std::min(rate, velocity[i] / least[i]);
  }
  return rate;
}

ToolRates bound_tool_rates(const RobotModel& robot, const JointPiece& piece) {
  constexpr int kParts = 64;
  const ForwardKinematics& arm = robot.forward();
  const double half = 0.5 * piece.length / kParts;
  const JointVector third = third_bound(piece);
  const double lever = lever_bound(arm, piece);

  ToolRates rates;
  for (int k = 0; k < kParts; ++k) {
    const PathPoint middle = piece.at((2 * k + 1) * half);
    const ChainFrames frames = arm.frames(middle.q);
    const Jacobian jacobian = arm.jacobian(frames);
    const double first = (jacobian.topRows<3>() * middle.q1).norm();
    const double second = (jacobian.topRows<3>() * middle.q2 +
                           arm.jacobian_rate(frames, middle.q1).topRows<3>() * middle.q1)
                              .norm();
    const double sum2 = (middle.q2.cwiseAbs() + half * third).sum();
    const JointVector spread = half * (middle.q2.cwiseAbs() + half * third);
    const double sum1 = (middle.q1.cwiseAbs() + spread).sum();
    // ‖d³p/ds³‖: every product of axes and rates that the chain rule makes, at the longest lever.
    const double remainder = lever * (sum1 * sum1 * sum1 + 3.0 * sum1 * sum2 + third.sum());
    rates.first = std::max(rates.first, first + half * second + 0.5 * half * half * remainder);
    rates.second = std::max(rates.second, second + half * remainder);
    rates.fastest = std::max(rates.fastest,
                             fastest_rate(middle.q1.cwiseAbs() - spread, robot.limits().velocity));
  }
  return rates;
}

}  // namespace

void limit_tool(const RobotModel& robot, JointPiece& piece, const ToolWishes& wishes) {
  if (!wishes.speed && !wishes.acceleration) return;
  const ToolRates rates = bound_tool_rates(robot, piece);
  if (rates.first <= 0.0) return;  // the tool point does not move
  if (wishes.speed) piece.rate_limit = std::min(piece.rate_limit, *wishes.speed / rates.first);
  if (!wishes.acceleration) return;
  // At most half of it may go into the curve; what the curve leaves is for speeding up.
  const double most = *wishes.acceleration;
  if (rates.second > 0.0) {
    piece.rate_limit = std::min(piece.rate_limit, std::sqrt(0.5 * most / rates.second));
  }
  const double rate = std::min(piece.rate_limit, rates.fastest);
  const double curve = rates.second > 0.0 ? rates.second * rate * rate : 0.0;
  piece.rate_change_limit = std::min(piece.rate_change_limit, (most - curve) / rates.first);
}

}  // namespace viapoint::planning
