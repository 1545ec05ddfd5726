/// @file
/// What the program could do instead, tried before it is offered.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planning/leg_builder.hpp"

namespace viapoint::planning {

/// A way that is tried, and what it is called where it works.
struct OtherWay {
  std::function<Leg()> build;
  const char* words;
};

inline constexpr const char* kByWrist =
    "the same curve of the tool position with the wrist joints interpolated: "
    "orientation=\"wrist\"";
inline constexpr const char* kByAllJoints =
    "the same curve with the orientation led by all joints: orientation=\"least\"";

/// Moves to the same goal from `start` that were found to work where a move on a tool curve does
/// not, each as a sentence.
/// @param goal where the move was to end
/// @param another the same move with the orientation led otherwise
[[nodiscard]] std::vector<std::string> ways_out_of(const Target& goal, const JointVector& start,
                                                   const LegBuilder& builder,
                                                   const OtherWay& another);

}  // namespace viapoint::planning
