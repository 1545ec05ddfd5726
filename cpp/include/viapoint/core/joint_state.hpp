/// @file
#pragma once

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// Position and its first three derivatives, each (n,) [rad or m, per s, s², s³].
struct JointState {
  JointVector q;
  JointVector qd;
  JointVector qdd;
  JointVector qddd;

  /// A state of `joints` joints at rest at zero.
  [[nodiscard]] static JointState zero(int joints) {
    const JointVector z = JointVector::Zero(joints);
    return {z, z, z, z};
  }
  /// At rest at `q`.
  [[nodiscard]] static JointState at_rest(const JointVector& q) {
    const JointVector z = JointVector::Zero(q.size());
    return {q, z, z, z};
  }
};

}  // namespace viapoint
