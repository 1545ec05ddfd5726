#include "trajectory/path_timing_tool.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/bernstein_bounds.hpp"

namespace viapoint::path_timing {
namespace {

/// A limited vector of the tool: its rate, and one over its limits.
struct Limited {
  const ToolRate* rate;
  double per_speed, per_acceleration;

  [[nodiscard]] bool counts() const { return per_speed > 0.0 || per_acceleration > 0.0; }
};

std::array<Limited, 2> limited(const ToolRates& tool) {
  const ToolLimits& limits = tool.limits;
  return {{{&tool.linear, 1.0 / limits.speed, 1.0 / limits.acceleration},
           {&tool.angular, 1.0 / limits.angular_speed, 1.0 / limits.angular_acceleration}}};
}

/// sup ‖w‖ and sup ‖w'‖ on [0, 1], w' the slope by u.
struct Sups {
  double value, slope;
};

Sups sups(const ToolRate& rate) {
  double value = 0.0, slope = 0.0;
  for (const auto& c : rate.coefficients) {
    const double most = largest_magnitude(c);
    const double steepest = largest_magnitude<5>({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5]});
    value += most * most;
    slope += steepest * steepest;
  }
  return {std::sqrt(value) + rate.error, std::sqrt(slope) + rate.slope_error};
}

}  // namespace

ToolPlace tool_at(const Stretch& stretch, double sigma) {
  const double u = sigma / stretch.length, once = 1.0 / stretch.length;
  ToolPlace place;
  const std::array<Limited, 2> both = limited(*stretch.tool);
  for (size_t k = 0; k < both.size(); ++k) {
    const Limited& here = both[k];
    if (!here.counts()) continue;
    double value2 = 0.0, slope2 = 0.0, product = 0.0;
    for (const auto& c : here.rate->coefficients) {
      const double w = c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
      const double w1 = c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])));
      value2 += w * w;
      slope2 += w1 * w1;
      product += w * w1;
    }
    const double value = std::sqrt(value2);
    place.velocity = std::max(place.velocity, (value + here.rate->error) * once * here.per_speed);
    const double along = value > 0.0 ? product / value : 0.0;
    const double across = std::sqrt(std::max(0.0, slope2 - along * along));
    place.cones[k] = {along * once * once * here.per_acceleration,
                      value * once * here.per_acceleration,
                      across * once * once * here.per_acceleration};
  }
  return place;
}

ToolBounds tool_bounds(const ToolRates& tool, const TimingSamples& samples) {
  // A speed to be held is no limit to press against: it is looked at by itself.
  const bool held = tool.limits.hold_speed;
  const double rate = samples.most_rate(), change = samples.most_change();
  ToolBounds bounds;
  for (Limited here : limited(tool)) {
    if (held && here.rate == &tool.linear) here.per_speed = 0.0;
    if (!here.counts()) continue;
    const ToolRate& w = *here.rate;
    const Rates reached = samples.reached(w.coefficients),
                between = samples.between(w.coefficients);
    const double speed_error = between.velocity + w.error * rate;
    const double change_error =
        between.acceleration + w.slope_error * rate * rate + w.error * change;
    bounds.reached.include(
        {reached.velocity * here.per_speed, reached.acceleration * here.per_acceleration, 0.0});
    bounds.proven.include({(reached.velocity + speed_error) * here.per_speed,
                           (reached.acceleration + change_error) * here.per_acceleration, 0.0});
  }
  return bounds;
}

ToolCeilings tool_ceilings(const ToolRates& tool, double length) {
  ToolCeilings ceilings;
  for (const Limited& here : limited(tool)) {
    if (!here.counts()) continue;
    const Sups most = sups(*here.rate);
    const auto raise = [](double& value, double other) { value = std::max(value, other); };
    raise(ceilings.velocity, most.value / length * here.per_speed);
    raise(ceilings.acceleration1, most.value / length * here.per_acceleration);
    raise(ceilings.acceleration2, most.slope / (length * length) * here.per_acceleration);
  }
  return ceilings;
}

}  // namespace viapoint::path_timing
