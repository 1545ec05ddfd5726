#include "path/quintic_extrema.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "viapoint/core/bernstein_bounds.hpp"

namespace viapoint {
namespace {

/// Intervals this narrow count as one point.
constexpr double kNarrowest = 1e-14;

struct Span {
  Quintic values;  ///< Bernstein coefficients
  double from;
  double width;
};

}  // namespace

double evaluate(const Quintic& quintic, double u) {
  double value = quintic[5];
  for (size_t k = 5; k-- > 0;) value = value * u + quintic[k];
  return value;
}

std::optional<double> first_positive(const Quintic& quintic) {
  std::vector<Span> open = {{to_bernstein(quintic), 0.0, 1.0}};
  while (!open.empty()) {
    Span span = open.back();
    open.pop_back();
    if (*std::max_element(span.values.begin(), span.values.end()) <= 0.0) continue;
    if (span.values[0] > 0.0) return span.from;
    if (span.width <= kNarrowest) return span.from + span.width;
    const double half = 0.5 * span.width;
    const Quintic lower = split_off_lower_half(span.values);
    open.push_back({span.values, span.from + half, half});
    open.push_back({lower, span.from, half});
  }
  return std::nullopt;
}

double maximum(const Quintic& quintic, double resolution) {
  return largest_value(to_bernstein(quintic), -std::numeric_limits<double>::infinity(), resolution);
}

}  // namespace viapoint
