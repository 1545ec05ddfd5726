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

std::vector<std::string> ways_out_of(const LinMove& failed, const JointVector& start,
                                     const LegBuilder& builder) {
  std::vector<std::string> ways;
  if (works([&] { return builder.ptp(PtpMove{failed.target}, start); })) {
    ways.emplace_back("a joint move to the same target: movej(...)");
  }
  if (failed.orientation != Orientation::kWrist &&
      works([&] { return builder.lin({failed.target, Orientation::kWrist}, start); })) {
    ways.emplace_back(
        "a straight line of the tool position with the wrist joints interpolated: "
        "movel(..., orientation=\"wrist\")");
  }
  return ways;
}

}  // namespace viapoint::planning
