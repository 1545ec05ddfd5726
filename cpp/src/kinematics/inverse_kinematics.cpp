#include "viapoint/kinematics/inverse_kinematics.hpp"

#include <algorithm>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

[[noreturn]] void refuse_redundancy(const std::string& family) {
  throw MotionError(ErrorCode::kUncontrolled,
                    "this arm leaves nothing open once the pose is given (" + family + ")",
                    {"ask without a redundancy"});
}

}  // namespace

double InverseKinematics::redundancy_of(const JointVector&) const { refuse_redundancy(family()); }

std::vector<JointVector> InverseKinematics::solve_all_at(const Pose&, double,
                                                         const JointVector&) const {
  refuse_redundancy(family());
}

std::vector<JointVector> InverseKinematics::solve_all(const Pose& pose_base_tool) const {
  return solve_all(pose_base_tool, JointVector::Zero(joints()));
}

std::vector<JointVector> InverseKinematics::solve_all(const Eigen::Vector3d& position) const {
  return solve_all(position, JointVector::Zero(joints()));
}

std::vector<JointVector> InverseKinematics::solve_all(const Pose& pose_base_tool,
                                                      const JointVector& reference,
                                                      const Configuration& wish) const {
  return in_configuration(solve_all(pose_base_tool, reference), wish);
}

std::vector<JointVector> InverseKinematics::in_configuration(std::vector<JointVector> all,
                                                             const Configuration& wish) const {
  const bool any = wish.shoulder == 0 && wish.elbow == 0 && wish.wrist == 0;
  if (any && wish.turns.size() == 0) return all;
  std::vector<std::string> others;
  std::erase_if(all, [&](const JointVector& q) {
    const Configuration found = configuration(q);
    if (found.fits(wish)) return false;
    others.push_back(found.describe());
    return true;
  });
  if (!all.empty()) return all;
  constexpr size_t kMostNamed = 8;
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  std::string list;
  for (size_t i = 0; i < std::min(others.size(), kMostNamed); ++i) {
    list += (list.empty() ? "" : "; ") + others[i];
  }
  if (others.size() > kMostNamed) list += "; and others";
  throw MotionError(ErrorCode::kOutsideLimits,
                    "no solution within the joint limits has the configuration " + wish.describe() +
                        "; there are: " + list,
                    {"ask for one of these", "leave the configuration open and give near joints"});
}

}  // namespace viapoint
