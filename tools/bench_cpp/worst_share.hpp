/// @file
/// How near a proven motion comes to its limits.
#pragma once

#include <algorithm>

#include "viapoint/trajectory/certificate.hpp"

namespace viapoint::bench {

/// The largest share of any limit of joints or tool.
inline double worst_share(const Certificate& certificate) {
  const ToolExtrema& tool = certificate.tool;
  double worst = std::max({tool.speed.share, tool.acceleration.share, tool.angular_speed.share,
                           tool.angular_acceleration.share});
  for (const auto* extrema :
       {&certificate.velocity, &certificate.acceleration, &certificate.jerk}) {
    for (const Extremum& extremum : *extrema) worst = std::max(worst, extremum.share);
  }
  return worst;
}

}  // namespace viapoint::bench
