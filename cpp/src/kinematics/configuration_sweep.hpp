/// @file
/// Every configuration that an arm of seven joints can hold a pose in.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "kinematics/closed_form.hpp"
#include "viapoint/core/joint_limits.hpp"

namespace viapoint {

/// Walks the parameter that the pose leaves open, and follows each configuration (sides and turns)
/// by its room: how far its worst joint is from leaving the limits or its turn, negative outside.
/// Where a branch begins or ends between two of the places looked at, the end is bisected; where
/// one that is missing comes nearest to being there, it is sought between the places (Brent 1973).
/// Between two places the room rises by no more than the joints move, so where that could bring it
/// above zero the places are halved, and its summits below zero are climbed. What it still misses
/// is a branch that another one, nearer to being there, hides, and joints that move on and back
/// between two places.
class ConfigurationSweep {
 public:
  using Solve = std::function<void(double parameter, ClosedSolutions& found)>;
  using Sides = std::array<int, 3>;  ///< signs of shoulder, elbow and wrist
  using Signs = std::function<Sides(const ArmSides&)>;
  /// True where q, within the limits, is an answer.
  using Accept = std::function<bool(const JointVector& q)>;

  ConfigurationSweep(const ForwardKinematics& forward, const JointLimits& limits);

  /// The roomiest answer of each configuration; of joints with a whole turn or more within their
  /// limits it has the turn nearest to `reference`, and not the others. @param count of places
  /// between `low` and `high`
  [[nodiscard]] std::vector<JointVector> find(double low, double high, int count,
                                              const JointVector& reference, const Solve& solve,
                                              const Signs& signs, const Accept& accept) const;

 private:
  /// One turn of one joint, as far as it lies within the limits.
  struct Window {
    double middle = 0.0;
    double half = 0.0;
  };
  /// Sides, and which window each joint is in.
  using Key = std::pair<Sides, std::vector<int>>;
  /// A branch on the turns of its key.
  struct Place {
    JointVector q;
    double room = 0.0;    ///< to the limits and the turn's ends [rad]; negative outside
    double margin = 0.0;  ///< to the limits, as a share of a joint's range
  };
  struct Track {
    std::map<double, Place> places;  ///< at each parameter where the branch exists
    std::optional<Place> best;
  };
  class Walk;
  /// Calls visit(key's turns, place) for each turn a branch may be on.
  template <typename Visit>
  void each_turn(const JointVector& branch, const JointVector& reference, Visit&& visit) const;
  [[nodiscard]] Place place_of(const JointVector& branch, const JointVector& reference,
                               const std::vector<int>& turns) const;

  JointLimits limits_;
  /// Of each joint: two at most where its limits leave less than a turn, or else none.
  std::vector<std::vector<Window>> windows_;
  std::vector<bool> slides_;
};

}  // namespace viapoint
