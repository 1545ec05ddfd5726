/// @file
/// The least value of a function of one variable that may be infinite in places.
/// Real-time: safe where the function is. Threads: none shared.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace viapoint {

struct ScalarMinimum {
  double x, value;
};

/// Refines a minimum between two neighbours by Brent's method (Brent 1973, ch. 5): parabolas where
/// they help, golden sections (Kiefer 1953) elsewhere.
/// @param best a place in [left, right] and the value there, finite
/// @param resolution no step is shorter, > 0
/// @param f not NaN; called at most `steps` times, never outside [left, right]
/// @return the least value seen, `best` among them
template <typename Function>
ScalarMinimum refined_minimum(double left, double right, ScalarMinimum best, double resolution,
                              int steps, Function f) {
  constexpr double kGolden = 0.3819660112501051;
  const double low = left, high = right;
  double second = best.x, second_value = best.value, third = best.x, third_value = best.value;
  double change = 0.0, before = 0.0;
  for (int step = 0; step < steps; ++step) {
    const double middle = 0.5 * (left + right);
    const double least = resolution + 1e-15 * std::abs(best.x);
    if (std::abs(best.x - middle) + 0.5 * (right - left) <= 2.0 * least) break;
    const double r = (best.x - second) * (best.value - third_value);
    double q = (best.x - third) * (best.value - second_value);
    double p = (best.x - third) * q - (best.x - second) * r;
    q = 2.0 * (q - r);
    if (q > 0.0) p = -p;
    q = std::abs(q);
    const bool parabola = std::isfinite(p) && std::abs(p) < std::abs(0.5 * q * before) &&
                          p > q * (left - best.x) && p < q * (right - best.x);
    before = change;
    if (parabola) {
      change = p / q;
    } else {
      before = best.x < middle ? right - best.x : left - best.x;
      change = kGolden * before;
    }
    const double to = best.x + (std::abs(change) >= least ? change : std::copysign(least, change));
    const double x = std::clamp(to, low, high);
    const double value = f(x);
    if (value <= best.value) {
      (x < best.x ? right : left) = best.x;
      third = second, third_value = second_value;
      second = best.x, second_value = best.value;
      best = {x, value};
    } else {
      (x < best.x ? left : right) = x;
      if (value <= second_value || second == best.x) {
        third = second, third_value = second_value;
        second = x, second_value = value;
      } else if (value <= third_value || third == best.x || third == second) {
        third = x, third_value = value;
      }
    }
  }
  return best;
}

/// Looks at `samples` places, denser toward both ends, and refines around the least. Where that is
/// an end and the function rises from there, it is taken as it is.
/// @param f not NaN; called at most `samples` + `steps` + 1 times. @pre samples >= 3
template <typename Function>
ScalarMinimum least_of(double low, double high, int samples, int steps, Function f) {
  constexpr double kResolution = 1e-7;
  const auto place = [&](int i) {
    if (i <= 0) return low;
    if (i + 1 >= samples) return high;
    return low + (high - low) * 0.5 * (1.0 - std::cos(std::numbers::pi * i / (samples - 1)));
  };
  ScalarMinimum best{low, std::numeric_limits<double>::infinity()};
  int at = 0;
  for (int i = 0; i < samples; ++i) {
    const double value = f(place(i));
    if (value < best.value) {
      best = {place(i), value};
      at = i;
    }
    if (!(high > low)) return best;
  }
  if (!std::isfinite(best.value)) return best;
  const double resolution = kResolution * (high - low);
  if (at == 0 && f(low + resolution) >= best.value) return best;
  if (at + 1 == samples && f(high - resolution) >= best.value) return best;
  return refined_minimum(place(at - 1), place(at + 1), best, resolution, steps, f);
}

}  // namespace viapoint
