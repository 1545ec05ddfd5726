#include "viapoint/trajectory/reachability_timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "trajectory/path_timing_course.hpp"
#include "trajectory/path_timing_range.hpp"
#include "trajectory/path_timing_span.hpp"
#include "trajectory/path_timing_valid.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kMostCells = 10000;
/// How much of what is proven may be slack, relative; and a hair for whoever checks it.
constexpr double kSlack = 1e-5, kMargin = 1.0 + 1e-12;

/// A place between cells: |bend[i] b + slope[i] a| <= 1 with a = s̈, and 0 <= b <= ceiling.
struct Place {
  std::array<double, kMaxJoints> bend{}, slope{};
  double ceiling = 0.0;
  double most = 0.0;  ///< b from which the rest can be driven
};

/// a between two lines in b: what they are at a b, and their slopes by it.
struct Interval {
  double low = -kInfinite, high = kInfinite;
  double low_slope = 0.0, high_slope = 0.0;

  /// |b · bend + a · slope| <= 1.
  void add(double b, double bend, double slope) {
    if (slope == 0.0) return;
    const double middle = -bend / slope, width = std::abs(1.0 / slope);
    raise(middle * b - width, middle);
    lower(middle * b + width, middle);
  }
  void raise(double value, double by_b) {
    if (value <= low) return;
    low = value;
    low_slope = by_b;
  }
  void lower(double value, double by_b) {
    if (value >= high) return;
    high = value;
    high_slope = by_b;
  }
};

/// The s̈ that take b through a cell of this length to a b of at most `to.most`.
Interval changes(const Place& from, const Place& to, double length, int joints, double b) {
  Interval interval;
  const double twice = 2.0 * length;
  interval.raise(-b / twice, -1.0 / twice);
  interval.lower((to.most - b) / twice, -1.0 / twice);
  for (size_t i = 0; i < static_cast<size_t>(joints); ++i) {
    interval.add(b, from.bend[i], from.slope[i]);
    interval.add(b, to.bend[i], to.slope[i] + twice * to.bend[i]);
  }
  return interval;
}

/// The largest b at `from` that can be driven through the cell. The width of the interval of s̈ is
/// concave in b, at least zero at b = 0 and made of lines: Newton's method from above ends on one.
double most_before(const Place& from, const Place& to, double length, int joints) {
  constexpr int kMostSteps = 100;
  double b = from.ceiling;
  for (size_t i = 0; i < static_cast<size_t>(joints); ++i) {
    if (from.slope[i] == 0.0) b = std::min(b, 1.0 / std::abs(from.bend[i]));
  }
  for (int step = 0; step < kMostSteps; ++step) {
    const Interval interval = changes(from, to, length, joints, b);
    const double width = interval.high - interval.low;
    if (width >= 0.0) return b;
    const double next = b - width / (interval.high_slope - interval.low_slope);
    if (!(next < b)) return b;  // rounding
    b = std::max(next, 0.0);
  }
  return b;
}

class Reachability {
 public:
  Reachability(const Course& course, int cells) : course_(course), cells_(cells) {
    const size_t stretches = course.stretches().size();
    places_.reserve(stretches * (static_cast<size_t>(cells) + 1));
    for (size_t k = 0; k < stretches; ++k) {
      for (int i = 0; i <= cells; ++i) places_.push_back(place(k, i));
    }
    // Where q' vanishes nothing bounds the speed: any ceiling will do, this far above the rest.
    constexpr double kDecades = 1e12;
    double least = kInfinite;
    for (const Place& place : places_) least = std::min(least, place.ceiling);
    for (Place& place : places_) place.ceiling = std::min(place.ceiling, kDecades * least);
  }

  std::vector<TimedSpan> run() {
    drive_back();
    return drive_on();
  }

 private:
  [[nodiscard]] Place& at(size_t stretch, int i) {
    return places_[stretch * (static_cast<size_t>(cells_) + 1) + static_cast<size_t>(i)];
  }
  [[nodiscard]] double s_of(const Stretch& stretch, int i) const {
    return stretch.length * i / cells_;
  }

  [[nodiscard]] Place place(size_t k, int i) const {
    const Stretch& stretch = course_.stretches()[k];
    JointRates rates;
    course_.rates(k, s_of(stretch, i), rates);
    double rate = 0.0;
    for (const double share : rates.velocity) rate = std::max(rate, std::abs(share));
    return {rates.acceleration2, rates.acceleration1, 1.0 / (rate * rate), 0.0};
  }

  void drive_back() {
    const auto& stretches = course_.stretches();
    double most = 0.0;  // of b at the end of the stretch
    for (size_t k = stretches.size(); k-- > 0;) {
      at(k, cells_).most = std::min(most, at(k, cells_).ceiling);
      for (int i = cells_ - 1; i >= 0; --i) {
        at(k, i).most =
            most_before(at(k, i), at(k, i + 1), stretches[k].length / cells_, course_.joints());
      }
      most = at(k, 0).most / (stretches[k].gear * stretches[k].gear);
    }
  }

  std::vector<TimedSpan> drive_on() {
    std::vector<TimedSpan> spans;
    spans.reserve(places_.size());
    double b = 0.0;
    for (size_t k = 0; k < course_.stretches().size(); ++k) {
      const Stretch& stretch = course_.stretches()[k];
      const double length = stretch.length / cells_;
      b = std::min(b * stretch.gear * stretch.gear, at(k, 0).most);
      for (int i = 0; i < cells_; ++i) {
        const Place& to = at(k, i + 1);
        const double change = changes(at(k, i), to, length, course_.joints(), b).high;
        const double next = std::clamp(b + 2.0 * length * change, 0.0, to.most);
        const double start = std::sqrt(b), end = std::sqrt(next);
        const RateState from{s_of(stretch, i), start, 0.5 * (next - b) / length};
        spans.push_back(TimedSpan::constant_jerk(k, stretch.length, from, 0.0, s_of(stretch, i + 1),
                                                 2.0 * length / (start + end)));
        b = next;
      }
    }
    return spans;
  }

  const Course& course_;
  int cells_;
  std::vector<Place> places_;  ///< of all stretches, the places at knots twice
};

}  // namespace
}  // namespace path_timing

std::vector<TrajectoryPiece> parameterize_without_jerk(const JointPath& path,
                                                       const JointLimits& limits, int cells) {
  using namespace path_timing;
  require_valid(path, limits);
  if (cells < 1 || cells > kMostCells) {
    throw MotionError(ErrorCode::kBadArgument, std::to_string(cells) +
                                                   " cells for each piece of path; allowed are 1 "
                                                   "to " +
                                                   std::to_string(kMostCells));
  }
  JointLimits without_jerk = limits;
  without_jerk.jerk.setConstant(kInfinite);
  const Course course(path, without_jerk);
  std::vector<TimedSpan> spans = Reachability(course, cells).run();
  stretch_time(spans, prove(course, spans, kSlack).stretch() * kMargin);
  if (!in_range(total_duration(spans))) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the path has no timing within the range of numbers: its speed, limits or "
                      "lengths are too extreme");
  }
  return to_pieces(path, spans);
}

}  // namespace viapoint
