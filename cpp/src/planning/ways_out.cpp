#include "planning/ways_out.hpp"

namespace viapoint::planning {
namespace {

/// True when `build` makes a leg. That it does not is an answer here, not a fault.
template <typename Build>
bool works(const Build& build) {
  try {
    const Leg leg = build();
    return !leg.path.empty();
  } catch (const MotionError&) {
    return false;
  }
}

}  // namespace

std::vector<std::string> ways_out_of(const Target& goal, const JointVector& start,
                                     const LegBuilder& builder, const OtherWay& another) {
  std::vector<std::string> ways;
  if (works([&] { return builder.ptp(PtpMove{goal}, start); })) {
    ways.emplace_back("a joint move to the same target: movej(...)");
  }
  if (works(another.build)) ways.emplace_back(another.words);
  return ways;
}

}  // namespace viapoint::planning
