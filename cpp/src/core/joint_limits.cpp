#include "viapoint/core/joint_limits.hpp"

#include <cmath>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_range.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

[[noreturn]] void refuse(int joint, const char* what, double value, const std::string& expected) {
  Problem problem;
  problem.code = ErrorCode::kBadLimits;
  problem.message = std::string(what) + " of joint " + std::to_string(joint + 1) + " is " +
                    number_text(value) + "; " + expected;
  problem.joint = joint;
  problem.value = value;
  throw MotionError(std::move(problem));
}

void require_size(Eigen::Index size, Eigen::Index joints, const char* what) {
  if (size == joints) return;
  throw MotionError(ErrorCode::kBadLimits,
                    std::string(what) + " has " + std::to_string(size) +
                        " entries, expected one a joint: " + std::to_string(joints));
}

void require_rates(const JointVector& rates, const char* what) {
  for (int i = 0; i < rates.size(); ++i) {
    if (!(rates[i] >= kLeastRate && rates[i] <= kMostRate)) {
      refuse(i, what, rates[i],
             "it must be positive and finite, between 1e-9 and 1e12 [rad or m, per s, s² or s³]");
    }
  }
}

}  // namespace

bool JointLimits::contains(const JointVector& q, double slack) const {
  for (int i = 0; i < joints(); ++i) {
    // Written so that NaN is outside.
    if (!(q[i] >= position_min[i] - slack && q[i] <= position_max[i] + slack)) return false;
  }
  for (int row = 0; row < couplings(); ++row) {
    double value = 0.0;
    for (int i = 0; i < joints(); ++i) value += coupling(row, i) * q[i];
    if (!(value >= coupling_lower[row] - slack && value <= coupling_upper[row] + slack)) {
      return false;
    }
  }
  return true;
}

void JointLimits::validate() const {
  if (joints() == 0) throw MotionError(ErrorCode::kBadLimits, "limits of no joint at all");
  require_size(position_min.size(), joints(), "position_min");
  require_size(position_max.size(), joints(), "position_max");
  require_size(acceleration.size(), joints(), "acceleration");
  require_size(jerk.size(), joints(), "jerk");
  for (int i = 0; i < joints(); ++i) {
    if (std::isnan(position_min[i])) refuse(i, "position_min", position_min[i], "not a number");
    if (!(position_max[i] > position_min[i])) {
      refuse(i, "position_max", position_max[i],
             "it must be above position_min, which is " + number_text(position_min[i]));
    }
  }
  require_rates(velocity, "velocity limit");
  require_rates(acceleration, "acceleration limit");
  require_rates(jerk, "jerk limit");

  if (couplings() == 0) return;
  if (coupling.cols() != joints()) {
    throw MotionError(ErrorCode::kBadLimits,
                      "coupling matrix C has " + std::to_string(coupling.cols()) +
                          " columns, expected one a joint: " + std::to_string(joints()));
  }
  if (!coupling.allFinite()) {
    throw MotionError(ErrorCode::kBadLimits, "coupling matrix C has an entry that is not finite");
  }
  require_size(coupling_lower.size(), couplings(), "coupling_lower");
  require_size(coupling_upper.size(), couplings(), "coupling_upper");
  for (int row = 0; row < couplings(); ++row) {
    if (!(coupling_upper[row] > coupling_lower[row])) {
      throw MotionError(ErrorCode::kBadLimits, "coupled limit " + std::to_string(row + 1) +
                                                   ": upper must be above lower, they are " +
                                                   number_text(coupling_upper[row]) + " and " +
                                                   number_text(coupling_lower[row]));
    }
  }
}

}  // namespace viapoint
