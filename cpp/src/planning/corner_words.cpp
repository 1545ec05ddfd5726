#include "planning/corner_words.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

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
    Advice{"too small", "a larger zone"},
    Advice{"no size", "a zone above zero"},
    Advice{"no tool", "zone=joint_deviation(rad)"},
    Advice{"proven", "a larger zone, or a smaller turn between the two moves"},
};

/// Three digits, rounded down so that it still fits.
std::string digits(double value) {
  if (!(value > 0.0)) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::floor(value / unit) * unit);
  return text;
}

std::string smaller_zone(const CornerOutcome& corner) {
  switch (corner.asked.kind) {
    case ZoneKind::kJointDeviation:
      return "zone=joint_deviation(" + digits(corner.used) + "), which fits";
    case ZoneKind::kDeviation:
      return "zone=deviation(" + digits(corner.used / kMillimetre) + " * mm), which fits";
    default:
      // Legs of unequal length: the shorter may still have no room for it.
      return "zone=" + digits(corner.used / kMillimetre) + " * mm, as large as was used";
  }
}

}  // namespace

std::vector<std::string> ways_out_of(const CornerOutcome& corner) {
  std::vector<std::string> ways;
  for (const Advice& advice : kAdvice) {
    if (corner.reason.find(advice.of) != std::string::npos) {
      ways.emplace_back(advice.way_out);
      break;
    }
  }
  ways.push_back(corner.stopped ? "zone=\"fine\" where the stop is as good" : smaller_zone(corner));
  return ways;
}

}  // namespace viapoint::planning
