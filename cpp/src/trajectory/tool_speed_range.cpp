#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint {
namespace {

constexpr std::size_t kSquareSize = 11;
/// Σ_k c[k] y^k.
using Square = std::array<double, kSquareSize>;

/// ‖w‖² by y, with u = middle + radius y.
Square square_about(const ToolRate& rate, double middle, double radius) {
  Square sum{};
  for (std::array<double, 6> c : rate.coefficients) {
    for (std::size_t first = 0; first < 5; ++first) {
      for (std::size_t k = 5; k-- > first;) c[k] += middle * c[k + 1];
    }
    double power = 1.0;
    for (double& value : c) {
      value *= power;
      power *= radius;
    }
    for (std::size_t i = 0; i < c.size(); ++i) {
      for (std::size_t j = 0; j < c.size(); ++j) sum[i + j] += c[i] * c[j];
    }
  }
  return sum;
}

/// Σ |c_k| and the same of the first two derivatives: bounds on |y| <= 1.
struct Magnitudes {
  double value = 0.0, slope = 0.0, bend = 0.0;
};

Magnitudes magnitudes(const Square& c) {
  Magnitudes m;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto n = static_cast<double>(k);
    m.value += std::abs(c[k]);
    m.slope += n * std::abs(c[k]);
    m.bend += n * (n - 1.0) * std::abs(c[k]);
  }
  return m;
}

/// A bound of f on an interval by its ends and sup |f''|, halved while it exceeds `known`.
template <typename Function>
struct Search {
  const Function& f;
  double second, known;

  [[nodiscard]] double bound(double from, double to, double first, double last,
                             int halvings) const {
    const double width = to - from;
    const double most = std::max(first, last) + 0.125 * second * width * width;
    if (most <= known || halvings == 0) return most;
    const double middle = 0.5 * (from + to), value = f(middle);
    return std::max(bound(from, middle, first, value, halvings - 1),
                    bound(middle, to, value, last, halvings - 1));
  }
};

}  // namespace

SpeedRange tool_speed_range(const std::array<double, 6>& timing, double duration,
                            const ToolRate& rate, double asked) {
  constexpr int kParts = 64;
  const auto& t = timing;
  double end = 0.0;
  for (const double c : t) end += c;
  // About the middle, and as far as u may go: its ends, and what its bend may add between them.
  double bend = 0.0, jerk = 0.0, slope = 0.0;  // sup |d^n u / dx^n|
  for (std::size_t k = 1; k < t.size(); ++k) {
    const auto n = static_cast<double>(k);
    slope += n * std::abs(t[k]);
    bend += n * (n - 1.0) * std::abs(t[k]);
    jerk += n * (n - 1.0) * (n - 2.0) * std::abs(t[k]);
  }
  const double middle = 0.5 * (t[0] + end);
  const double radius = 0.5 * std::abs(end - t[0]) + bend / 8.0;
  SpeedRange range;
  if (!(radius > 0.0)) return range;
  const Square square = square_about(rate, middle, radius);
  const Magnitudes g = magnitudes(square);
  // d²/dx² of g(y(x)) u'²: y' = u'/radius, and so on.
  const double y1 = slope / radius, y2 = bend / radius;
  const double second =
      ((g.bend * y1 * y1 + g.slope * y2) * slope + 4.0 * g.slope * y1 * bend) * slope +
      2.0 * g.value * (bend * bend + slope * jerk);
  const double rounding = 1e-14 * g.value * slope * slope;
  const auto value_at = [&](double x) {
    const double u = t[0] + x * (t[1] + x * (t[2] + x * (t[3] + x * (t[4] + x * t[5]))));
    const double u1 = t[1] + x * (2 * t[2] + x * (3 * t[3] + x * (4 * t[4] + x * 5 * t[5])));
    const double y = (u - middle) / radius;
    double value = 0.0;
    for (std::size_t i = kSquareSize; i-- > 0;) value = value * y + square[i];
    return value * u1 * u1;
  };
  const double error = rate.error * slope;
  const double known = std::max(0.0, asked * duration - error);
  const Search<decltype(value_at)> search{value_at, second, known * known};
  double least = std::numeric_limits<double>::infinity(), most = 0.0, before = 0.0;
  for (int k = 0; k <= kParts; ++k) {
    const double x = static_cast<double>(k) / kParts;
    const double value = value_at(x);
    least = std::min(least, value);
    if (k > 0) most = std::max(most, search.bound(x - 1.0 / kParts, x, before, value, 8));
    before = value;
  }
  range.reached = std::sqrt(std::max(0.0, least)) / duration;
  const double low = least - second / (8.0 * kParts * kParts) - rounding;
  range.least = std::max(0.0, std::sqrt(std::max(0.0, low)) - error) / duration;
  range.most = (std::sqrt(std::max(0.0, most + rounding)) + error) / duration;
  return range;
}

}  // namespace viapoint
