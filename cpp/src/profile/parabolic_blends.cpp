#include "viapoint/profile/parabolic_blends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

/// What a law of lines and blends is asked for, but for the accelerations.
struct Request {
  std::span<const double> points, durations;
  std::span<const size_t> straight_at_middle;
};

/// The timing of lines and blends, all that the law is laid out from.
struct Timing {
  std::vector<double> acceleration, blend, velocity, linear;
  /// Smallest time left beside the blends as a share of its segment; −∞ where an end blend has no
  /// solution.
  double least_room = std::numeric_limits<double>::infinity();
  size_t tightest = 0;
};

double sign(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }

/// `ends`: blends of equal length within the segment that start or end at rest. With a blend of t
/// at one end |Δq| = a t (T − t/2); with one at both |Δq| = a t (T − t). The smaller root of
/// either; NaN where there is none.
double end_blend_time(double gap, double duration, double acceleration, int ends) {
  const double under = duration * duration - 2.0 * ends * std::abs(gap) / acceleration;
  if (under < 0.0) return std::numeric_limits<double>::quiet_NaN();
  // (T − √(T² − c))/ends without the cancellation.
  return 2.0 * std::abs(gap) / acceleration / (duration + std::sqrt(under));
}

Timing time_blends(const Request& request, std::span<const double> magnitudes) {
  const auto& [points, durations, straight_at_middle] = request;
  const size_t last = durations.size() - 1;
  const auto magnitude = [&](size_t i) { return magnitudes[magnitudes.size() == 1 ? 0 : i]; };
  Timing timing;
  timing.acceleration.assign(points.size(), 0.0);
  timing.blend.assign(points.size(), 0.0);
  const auto tighten = [&](double room, size_t segment) {
    if (room < timing.least_room) timing.least_room = room, timing.tightest = segment;
  };
  for (size_t i = 0; i <= last; ++i) {
    const double gap = points[i + 1] - points[i];
    double moving = durations[i];  // time the segment would take at its linear velocity
    const int ends = (i == 0 ? 1 : 0) + (i == last ? 1 : 0);
    // With both ends in one segment the blends are made alike, at the smaller acceleration.
    const double a = ends == 2 ? std::min(magnitude(0), magnitude(1))
                               : magnitude(i == 0 ? 0 : points.size() - 1);
    if (ends > 0) {
      const double blend = end_blend_time(gap, durations[i], a, ends);
      if (std::isnan(blend)) {
        tighten(-std::numeric_limits<double>::infinity(), i);
        return timing;
      }
      if (i == 0) timing.blend[0] = blend, timing.acceleration[0] = sign(gap) * a;
      if (i == last) timing.blend[last + 1] = blend, timing.acceleration[last + 1] = -sign(gap) * a;
      moving -= 0.5 * ends * blend;
    }
    timing.velocity.push_back(gap / moving);
  }
  for (size_t i = 1; i <= last; ++i) {
    const double change = timing.velocity[i] - timing.velocity[i - 1];
    timing.acceleration[i] = sign(change) * magnitude(i);
    timing.blend[i] = std::abs(change) / magnitude(i);
  }
  for (size_t i = 0; i <= last; ++i) {
    // An end blend lies wholly inside its segment, an inner one by half.
    const double before = timing.blend[i] * (i == 0 ? 1.0 : 0.5);
    const double after = timing.blend[i + 1] * (i == last ? 1.0 : 0.5);
    timing.linear.push_back(durations[i] - before - after);
    tighten(timing.linear.back() / durations[i], i);
  }
  for (const size_t i : straight_at_middle) {
    tighten(0.5 - 0.5 * std::max(timing.blend[i], timing.blend[i + 1]) / durations[i], i);
  }
  return timing;
}

/// Negative linear times down to here are rounding (a blend that just fits).
constexpr double kRoomSlack = -1e-12;

/// The least common acceleration that leaves no linear time negative. Coarse steps upwards from
/// what the ends need find the first that works; halving closes in on it.
double least_acceleration(const Request& request) {
  const auto& [points, durations, straight_at_middle] = request;
  const auto works = [&](double a) {
    return time_blends(request, std::span(&a, 1)).least_room >= kRoomSlack;
  };
  double high = std::numeric_limits<double>::min();  // steps from 0 would lead nowhere
  for (size_t i = 0; i < durations.size(); ++i) {
    high = std::max(high, std::abs(points[i + 1] - points[i]) / (durations[i] * durations[i]));
  }
  double low = 0.0;
  while (!works(high) && std::isfinite(high)) {
    low = high;
    high *= 1.01;
  }
  for (int round = 0; round < 100 && high - low > 1e-13 * high; ++round) {
    const double middle = 0.5 * (low + high);
    (works(middle) ? high : low) = middle;
  }
  return high;
}

void require_accelerations(size_t points, std::span<const double> accelerations) {
  require_positive(accelerations, "accelerations");
  if (accelerations.size() == 1 || accelerations.size() == points) return;
  refuse(std::to_string(points) + " points need as many accelerations, or one for all, but " +
             std::to_string(accelerations.size()) + " were given",
         static_cast<double>(accelerations.size()), static_cast<double>(points));
}

[[noreturn]] void refuse_acceleration(const Timing& timing, const Request& request,
                                      std::span<const double> accelerations) {
  const double given = *std::min_element(accelerations.begin(), accelerations.end());
  const double least = least_acceleration(request);
  const size_t i = timing.tightest;
  // Rounded up in the last digit shown, so that the number in the message works, too.
  refuse("an acceleration of " + written(given) + " leaves no linear part in segment " +
             std::to_string(i) + " (" + written(request.points[i]) + " to " +
             written(request.points[i + 1]) + " in " + written(request.durations[i]) +
             " s); at least " + written(least * (1.0 + 1e-6)) + " is needed in every blend",
         given, least, {"give a larger acceleration", "give the segment more time"});
}

AxisLaw lay_out(std::span<const double> points, std::span<const double> durations,
                const Timing& timing) {
  std::vector<Polynomial> parts;
  double t = 0.0;
  AxisState state{points[0], 0.0, 0.0, 0.0};
  const auto go_on = [&](double seconds, double acceleration) {
    if (!(seconds > 0.0)) return;
    Polynomial part{0.0, seconds, {state.q, state.qd, 0.5 * acceleration, 0.0, 0.0, 0.0}};
    state = part.at(seconds);
    part.t0 = t;
    part.t1 = t + seconds;
    parts.push_back(part);
    t += seconds;
  };
  for (size_t i = 0; i < durations.size(); ++i) {
    go_on(timing.blend[i], timing.acceleration[i]);
    state.qd = timing.velocity[i];  // rounding does not add up from line to line
    go_on(timing.linear[i], 0.0);
  }
  go_on(timing.blend.back(), timing.acceleration.back());
  return AxisLaw(std::move(parts));
}

}  // namespace

BlendedLines blended_lines(std::span<const double> points, std::span<const double> durations,
                           std::span<const double> accelerations,
                           std::span<const size_t> straight_at_middle) {
  require_segments(points.size(), durations.size(), "durations");
  require_finite(points, "points");
  require_positive(durations, "durations");
  require_accelerations(points.size(), accelerations);
  for (const size_t segment : straight_at_middle) {
    if (segment < durations.size()) continue;
    refuse("there is no segment " + std::to_string(segment) + " to be straight at its middle",
           static_cast<double>(segment), static_cast<double>(durations.size() - 1));
  }
  const Request request{points, durations, straight_at_middle};
  Timing timing = time_blends(request, accelerations);
  if (!(timing.least_room >= kRoomSlack)) refuse_acceleration(timing, request, accelerations);
  for (double& linear : timing.linear) linear = std::max(0.0, linear);
  return {lay_out(points, durations, timing),
          {durations.begin(), durations.end()},
          timing.acceleration,
          timing.blend,
          timing.velocity,
          timing.linear};
}

std::vector<double> durations_at_speed(std::span<const double> points,
                                       std::span<const double> speeds,
                                       std::span<const double> accelerations) {
  require_segments(points.size(), speeds.size() == 1 ? points.size() - 1 : speeds.size(), "speeds");
  require_finite(points, "points");
  require_positive(speeds, "speeds");
  require_accelerations(points.size(), accelerations);
  const auto magnitude = [&](size_t k) { return accelerations[accelerations.size() == 1 ? 0 : k]; };
  std::vector<double> durations;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const double gap = std::abs(points[i + 1] - points[i]);
    const double speed = speeds[speeds.size() == 1 ? 0 : i];
    if (!(gap > 0.0)) {
      durations.push_back(0.0);
      continue;
    }
    const bool first = i == 0, last = i + 2 == points.size();
    const int ends = (first ? 1 : 0) + (last ? 1 : 0);
    const double a =
        ends == 2 ? std::min(magnitude(0), magnitude(1)) : magnitude(first ? 0 : i + 1);
    // From rest, and to it, the blends cover ends v²/(2a).
    const double most = std::sqrt(2.0 * a * gap / std::max(ends, 1));
    if (ends > 0 && !(speed <= most)) {
      refuse("a speed of " + written(speed) + " is not reached in segment " + std::to_string(i) +
                 " with an acceleration of " + written(a) + "; it must be at most " + written(most),
             speed, most, {"give a smaller speed", "give a larger acceleration"});
    }
    durations.push_back(gap / speed + 0.5 * ends * speed / a);
  }
  return durations;
}

AxisLaw parabolic_blend(double w0, double w1, double w2, double before, double after,
                        double half_width) {
  require_finite(std::array{w0, w1, w2}, "w");
  require_positive(before, "before");
  require_positive(after, "after");
  if (!(half_width > 0.0 && half_width <= std::min(before, after))) {
    refuse("a half width of " + written(half_width) + " s does not fit between segments of " +
               written(before) + " and " + written(after) +
               " s; it must be greater than 0 and at "
               "most " +
               written(std::min(before, after)) + " s",
           half_width, std::min(before, after));
  }
  const double slope_before = (w1 - w0) / before, slope_after = (w2 - w1) / after;
  const double bend = 0.5 * (slope_after - slope_before) / half_width;
  const Polynomial first{0.0, before - half_width, {w0, slope_before}};
  const Polynomial blend{before - half_width,
                         before + half_width,
                         {w1 - half_width * slope_before, slope_before, 0.5 * bend}};
  const Polynomial second{
      before + half_width, before + after, {w1 + half_width * slope_after, slope_after}};
  std::vector<Polynomial> parts;
  for (const Polynomial& part : {first, blend, second}) {
    if (part.t1 > part.t0) parts.push_back(part);
  }
  return AxisLaw(std::move(parts));
}

}  // namespace viapoint
