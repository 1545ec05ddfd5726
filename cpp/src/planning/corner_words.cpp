#include "planning/corner_words.hpp"

#include <array>
#include <string_view>

#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint::planning {
namespace {

/// A part of a reason, and what helps against it.
struct Advice {
  std::string_view of;
  std::string_view way_out;
};

constexpr std::array kAdvice{
    Advice{"too short", "move the points farther apart, or leave out one of them"},
    Advice{"turns back", "add a point beside this one, so that the path goes round it"},
    Advice{"joint limits", "turn the corner farther away from the limit, or on another branch"},
    Advice{"quicker", "a larger zone"},
    Advice{"tool changes", "change the tool at a move with zone=\"fine\""},
    Advice{"angle is too small", "a larger angle of the zone"},
    Advice{"too small", "a larger zone"},
    Advice{"no size", "a zone above zero"},
    Advice{"no tool", "zone=joint_deviation(rad)"},
    Advice{"proven", "a larger zone, or a smaller turn between the two moves"},
};

std::string smaller_zone(const CornerOutcome& corner) {
  const std::string millimetres = rounded_down_text(corner.used / kMillimetre) + " * mm";
  std::string angle;
  if (corner.asked.bounds_angle()) {
    angle = ", angle=" + rounded_down_text(corner.asked.angle / kDegree) + " * deg";
  }
  switch (corner.asked.kind) {
    case ZoneKind::kJointDeviation:
      return "zone=joint_deviation(" + rounded_down_text(corner.used) + "), which fits";
    case ZoneKind::kDeviation:
      return "zone=deviation(" + millimetres + angle + "), which fits";
    default:
      // Legs of unequal length: the shorter may still have no room for it.
      return "zone=" + (angle.empty() ? millimetres : "radius(" + millimetres + angle + ")") +
             ", as large as was used";
  }
}

}  // namespace

std::vector<std::string> ways_out_of(const CornerOutcome& corner) {
  std::vector<std::string> ways;
  for (const Advice& advice : kAdvice) {
    if (corner.reason.find(advice.of) != std::string::npos) {
      ways.emplace_back(advice.way_out);
      if (corner.angle_rules && corner.used_angle > 0.9 * corner.asked.angle) {
        ways.insert(ways.begin(), "a larger angle of the zone: it is used up before the size");
      }
      break;
    }
  }
  ways.push_back(corner.stopped ? "zone=\"fine\" where the stop is as good" : smaller_zone(corner));
  return ways;
}

}  // namespace viapoint::planning
