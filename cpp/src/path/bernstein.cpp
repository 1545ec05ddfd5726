#include "path/bernstein.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace viapoint {
namespace {

/// Intervals this narrow count as one point.
constexpr double kNarrowest = 1e-14;

struct Span {
  Bernstein values;
  double from;
  double width;
};

std::pair<Span, Span> halves(const Span& span) {
  Span left{span.values, span.from, 0.5 * span.width};
  Span right{span.values, span.from + 0.5 * span.width, 0.5 * span.width};
  Bernstein& work = right.values;
  for (size_t level = 1; level < 6; ++level) {
    left.values[level - 1] = work[0];
    for (size_t k = 0; k + level < 6; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
  }
  left.values[5] = work[0];
  return {left, right};
}

double largest(const Bernstein& values) { return *std::max_element(values.begin(), values.end()); }

}  // namespace

Bernstein control_values(const Quintic& quintic) {
  // b_i = Σ_{k<=i} C(i,k)/C(5,k) a_k.
  constexpr std::array<std::array<double, 6>, 6> kRatio = {{
      {1, 0, 0, 0, 0, 0},
      {1, 1.0 / 5, 0, 0, 0, 0},
      {1, 2.0 / 5, 1.0 / 10, 0, 0, 0},
      {1, 3.0 / 5, 3.0 / 10, 1.0 / 10, 0, 0},
      {1, 4.0 / 5, 6.0 / 10, 4.0 / 10, 1.0 / 5, 0},
      {1, 1, 1, 1, 1, 1},
  }};
  Bernstein values{};
  for (size_t i = 0; i < 6; ++i) {
    for (size_t k = 0; k <= i; ++k) values[i] += kRatio[i][k] * quintic[k];
  }
  return values;
}

double evaluate(const Quintic& quintic, double u) {
  double value = quintic[5];
  for (size_t k = 5; k-- > 0;) value = value * u + quintic[k];
  return value;
}

std::optional<double> first_positive(const Quintic& quintic) {
  std::vector<Span> open = {{control_values(quintic), 0.0, 1.0}};
  while (!open.empty()) {
    const Span span = open.back();
    open.pop_back();
    if (largest(span.values) <= 0.0) continue;
    if (span.values[0] > 0.0) return span.from;
    if (span.width <= kNarrowest) return span.from + span.width;
    auto [left, right] = halves(span);
    open.push_back(right);
    open.push_back(left);
  }
  return std::nullopt;
}

double maximum(const Quintic& quintic, double resolution) {
  double seen = -std::numeric_limits<double>::infinity();
  double proven = seen;
  std::vector<Span> open = {{control_values(quintic), 0.0, 1.0}};
  while (!open.empty()) {
    const Span span = open.back();
    open.pop_back();
    seen = std::max({seen, span.values[0], span.values[5]});
    const double bound = largest(span.values);
    if (bound <= seen + resolution || span.width <= kNarrowest) {
      proven = std::max(proven, bound);
      continue;
    }
    auto [left, right] = halves(span);
    open.push_back(right);
    open.push_back(left);
  }
  return proven;
}

}  // namespace viapoint
