/// @file
/// Inverse kinematics of any chain by damped least squares from many starts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinematics/descent.hpp"
#include "kinematics/limited_inverse.hpp"

namespace viapoint {

/// Descents (see Descent) started from `near` and from the points of a Halton sequence (Halton
/// 1960), in turn free (wrapped into the limits at the end) and held within the limits all the way.
/// The budget is one of iterations, never of time: the answer is the same on any machine under any
/// load.
class NumericalInverse final : public LimitedInverse {
 public:
  NumericalInverse(const ForwardKinematics& forward, const JointLimits& limits, std::string why);

  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::vector<JointVector> all(const InverseTask& task,
                                             const JointVector& reference) const override;
  [[nodiscard]] JointVector near(const InverseTask& task,
                                 const JointVector& reference) const override;
  [[nodiscard]] JointVector near_unlimited(const InverseTask& task,
                                           const JointVector& reference) const override;
  /// Where one descent from `reference`, within the limits all the way, arrives, if it does.
  /// @param leash it may not bring a joint farther than this from the reference [rad or m]
  [[nodiscard]] std::optional<JointVector> follow(const InverseTask& task,
                                                  const JointVector& reference,
                                                  double leash = 1e300) const;
  /// The first solution within the limits that the starts find, without a word where there is none.
  [[nodiscard]] std::optional<JointVector> find(const InverseTask& task,
                                                const JointVector& reference) const;
  /// Every distinct branch that the search finds within the limits; none without a word.
  [[nodiscard]] std::vector<JointVector> find_all(const InverseTask& task,
                                                  const JointVector& reference) const;
  [[nodiscard]] const Descent& descent() const { return descent_; }

 private:
  /// What all starts together found.
  struct Search {
    std::vector<JointVector> inside;   ///< distinct branches within the limits
    std::vector<JointVector> outside;  ///< distinct branches that are not
    PoseError least{1e300, 1e300};     ///< nearest miss
    JointVector nearest;               ///< where that was
  };

  /// @param reference the turn nearest to it is kept; @param enough stop at so many branches
  [[nodiscard]] Search search(const InverseTask& task, const JointVector& reference, int starts,
                              size_t enough) const;
  void add(const InverseTask& task, const JointVector& branch,
           std::vector<JointVector>& branches) const;
  [[nodiscard]] JointVector start(int index) const;
  [[nodiscard]] bool redundant(const InverseTask& task) const;
  [[noreturn]] void refuse(const InverseTask& task, const Search& search) const;

  std::string why_;
  double length_ = 1.0;  ///< the arm's size [m], to weigh metres against radians
  Descent descent_;
  std::array<bool, 6> moves_{};  ///< x, y, z, and turns about them: what the arm can move
};

}  // namespace viapoint
