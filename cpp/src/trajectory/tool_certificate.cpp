#include "viapoint/trajectory/tool_certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/rate_bounds.hpp"

namespace viapoint {
namespace {

/// Of a bound below its limit, and of one above it, as a share of the limit.
constexpr double kTightInside = 1e-4, kTightness = 1e-7;
constexpr int kParts = 4;
/// Intervals of less than a millionth of a piece say no more: what is left counts with its bound.
constexpr int kMostHalvings = 20;

/// One limited vector of the tool over one piece.
struct Search {
  const TrajectoryPiece& piece;
  const ToolRate& rate;
  double per_speed, per_acceleration;
  double time;
  double &speed_reached, &acceleration_reached;
  Extremum &speed, &acceleration;

  void take(double& reached, Extremum& worst, double found, double bound, double x) {
    if (found > reached) {
      reached = found;
      worst.time = time + x * piece.duration;
      worst.move = piece.move;
    }
    // Written so that NaN is kept once it is there.
    if (!(bound <= worst.share)) worst.share = bound;
  }

  void look(double from, double to, int halvings) {
    const TimingSamples samples(piece.timing, piece.duration, kParts, from, to);
    const Rates found = samples.reached(rate.coefficients);
    const Rates more = samples.between(rate.coefficients);
    // With the error of the rates: no more than at the sample that is the worst, and as a bound.
    const auto speed_share = [&](double speed_there, double u1) {
      return (speed_there + rate.error * u1) * per_speed;
    };
    const auto acceleration_share = [&](double there, double u1, double u2) {
      return (there + rate.slope_error * u1 * u1 + rate.error * u2) * per_acceleration;
    };
    const double v = speed_share(found.velocity, samples.least_rate());
    const double v_bound = speed_share(found.velocity + more.velocity, samples.most_rate());
    const double a =
        acceleration_share(found.acceleration, samples.least_rate(), samples.least_change());
    const double a_bound = acceleration_share(found.acceleration + more.acceleration,
                                              samples.most_rate(), samples.most_change());
    // Halving helps where the bound may be less than it is, unless all is well already.
    const auto open = [](double bound, double reached, double known) {
      const double slack = bound <= 1.0 ? kTightInside : kTightness;
      return !(bound <= known) && !(bound <= reached + slack);
    };
    if (halvings > 0 && (open(v_bound, v, std::max(speed.share, speed_reached)) ||
                         open(a_bound, a, std::max(acceleration.share, acceleration_reached)))) {
      const double middle = 0.5 * (from + to);
      look(from, middle, halvings - 1);
      look(middle, to, halvings - 1);
      return;
    }
    const double middle = 0.5 * (from + to);
    take(speed_reached, speed, v, v_bound, middle);
    take(acceleration_reached, acceleration, a, a_bound, middle);
  }
};

}  // namespace

void ToolCertifier::add(const TrajectoryPiece& piece, const ToolRates& rates, double time) {
  const ToolLimits& limits = rates.limits;
  const auto search = [&](const ToolRate& rate, double most_speed, double most_acceleration,
                          size_t first, Extremum& speed, Extremum& acceleration) {
    if (!(most_speed < ToolLimits::kNone) && !(most_acceleration < ToolLimits::kNone)) return;
    const double speed_before = speed.share, acceleration_before = acceleration.share;
    Search{piece,
           rate,
           1.0 / most_speed,
           1.0 / most_acceleration,
           time,
           reached_[first],
           reached_[first + 1],
           speed,
           acceleration}
        .look(0.0, 1.0, kMostHalvings);
    if (speed.share > speed_before) speed.value = speed.share * most_speed;
    if (acceleration.share > acceleration_before) {
      acceleration.value = acceleration.share * most_acceleration;
    }
  };
  search(rates.linear, limits.speed, limits.acceleration, 0, extrema_.speed, extrema_.acceleration);
  search(rates.angular, limits.angular_speed, limits.angular_acceleration, 2,
         extrema_.angular_speed, extrema_.angular_acceleration);
}

}  // namespace viapoint
