/// @file
#pragma once

#include <array>
#include <cstddef>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// The most branches a closed form has: eight, doubled where a singular pose splits one.
inline constexpr int kMostBranches = 16;

/// Joint vectors in a fixed place: no heap.
class BranchSet {
 public:
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const JointVector& operator[](int i) const {
    return q_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const JointVector* begin() const { return q_.data(); }
  [[nodiscard]] const JointVector* end() const { return q_.data() + size_; }
  void clear() { size_ = 0; }
  /// @pre size() < kMostBranches
  void push_back(const JointVector& q) { q_[static_cast<std::size_t>(size_++)] = q; }

 private:
  int size_ = 0;
  std::array<JointVector, kMostBranches> q_;
};

/// How InverseKinematics::solve_branches() ended.
enum class BranchStatus {
  kSolved,         ///< at least one branch
  kUnreachable,    ///< out of reach
  kOutsideLimits,  ///< reachable, but on no branch within the limits
  kBadArgument,    ///< a pose that is none, or joints of another number
  kNoClosedForm,   ///< this arm is solved by search
};

}  // namespace viapoint
