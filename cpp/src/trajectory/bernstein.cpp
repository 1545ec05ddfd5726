#include "viapoint/trajectory/bernstein.hpp"

#include <algorithm>
#include <utility>

namespace viapoint {

double BernsteinPolynomial::hull() const { return *std::ranges::max_element(coefficients()); }

BernsteinPolynomial BernsteinPolynomial::operator-() const {
  BernsteinPolynomial negative = *this;
  for (double& b : negative.coefficients()) b = -b;
  return negative;
}

double BernsteinPolynomial::operator()(double x) const {
  auto b = coefficients_;
  for (std::size_t left = size_; left > 1; --left) {
    for (std::size_t i = 0; i + 1 < left; ++i) b[i] += x * (b[i + 1] - b[i]);
  }
  return b[0];
}

BernsteinPolynomial BernsteinPolynomial::split_off_upper_half() {
  BernsteinPolynomial upper(degree());
  std::array<double, kMaxBernsteinDegree + 1> b = coefficients_;
  for (std::size_t r = 0; r < size_; ++r) {
    const std::size_t last = size_ - 1 - r;
    coefficients_[r] = b[0];
    upper.coefficients_[last] = b[last];
    for (std::size_t i = 0; i < last; ++i) b[i] = 0.5 * (b[i] + b[i + 1]);
  }
  return upper;
}

namespace {

/// A part of the polynomial under search: f on [start, start + width].
struct Part {
  BernsteinPolynomial f;
  double start = 0.0;
  double width = 1.0;
};

/// Halving further would not move x any more: a double has 52 bits.
constexpr double kMinWidth = 0x1p-50;
constexpr std::size_t kStackSize = 52;
/// Guards against coefficients so large that rounding alone exceeds the tolerance: what is left
/// then counts with its hull, which is loose but true.
constexpr int kMaxSplits = 10000;

/// Rounding of up to 50 halvings, as a share of the largest coefficient: 25 means each, by half an
/// epsilon.
constexpr double kSplitRounding = 50 * 12.5 * std::numeric_limits<double>::epsilon();

bool finite(const BernsteinPolynomial& f) {
  double sum = 0.0;
  for (const double b : f.coefficients()) sum += 0.0 * b;
  return sum == 0.0;
}

/// Bounds f and takes its ends as reached. True where that is all there is to know of it.
bool close(Peak& peak, std::optional<double>& place, double tolerance, double rounding,
           const BernsteinPolynomial& f, double start, double width) {
  if (f.first() > peak.reached) {
    peak.reached = f.first();
    place = start;
  }
  if (f.last() > peak.reached) {
    peak.reached = f.last();
    place = start + width;
  }
  const double hull = f.hull();
  if (hull > peak.reached + tolerance) return false;
  peak.bound = std::max(peak.bound, hull + rounding);
  return true;
}

/// Replaces the part on top of the stack by those of its halves that are still open, the more
/// promising one on top. Returns the new size.
template <typename Closed>
std::size_t halve(std::array<Part, kStackSize>& stack, std::size_t size, const Closed& closed) {
  Part& lower = stack[size - 1];
  Part& upper = stack[size];
  lower.width *= 0.5;
  upper.f = lower.f.split_off_upper_half();
  upper.start = lower.start + lower.width;
  upper.width = lower.width;
  // Twice: what the upper half reaches may close the lower one.
  bool lower_closed = closed(lower);
  const bool upper_closed = closed(upper);
  lower_closed = lower_closed || closed(lower);
  if (lower_closed && upper_closed) return size - 1;
  if (upper_closed) return size;
  if (lower_closed) {
    lower = upper;
    return size;
  }
  if (lower.f.hull() > upper.f.hull()) std::swap(lower, upper);
  return size + 1;
}

}  // namespace

std::optional<double> raise(Peak& peak, const BernsteinPolynomial& f, double tolerance,
                            double rounding) {
  if (!finite(f)) {
    peak.reached = peak.bound = std::numeric_limits<double>::infinity();
    return 0.0;
  }
  std::optional<double> place;
  if (close(peak, place, tolerance, rounding, f, 0.0, 1.0)) return place;

  rounding += kSplitRounding * std::max(f.hull(), (-f).hull());
  const auto closed = [&](const Part& part) {
    return close(peak, place, tolerance, rounding, part.f, part.start, part.width);
  };
  std::array<Part, kStackSize> stack;
  stack[0].f = f;
  std::size_t size = 1;
  for (int splits = 0; size > 0; ++splits) {
    const Part& top = stack[size - 1];
    // What was reached since may have closed this part.
    if (closed(top)) {
      --size;
    } else if (top.width < kMinWidth || splits >= kMaxSplits) {
      peak.bound = std::max(peak.bound, top.f.hull() + rounding);
      --size;
    } else {
      size = halve(stack, size, closed);
    }
  }
  return place;
}

}  // namespace viapoint
