#include "viapoint/path/curve_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/path/spline.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint {
namespace {

constexpr int kFirstSpans = 8;
constexpr int kPlacesInside = 8;
constexpr size_t kMostPoses = 20000;
/// Spans shorter than this share of the curve are not halved any more.
constexpr double kShortestSpan = 1e-7;
/// Neighbours that turn farther than this are halved unseen: their least rotation may be another
/// one than the curve's [rad].
constexpr double kMostTurn = 1.0;

/// The spline through poses.
ToolCurve spline_of(const CurveFit& fit) {
  std::vector<double> at;
  std::vector<JointVector> positions;
  std::vector<Eigen::Matrix3d> rotations;
  for (size_t k = 0; k < fit.at.size(); ++k) {
    at.push_back(fit.at[k] - fit.at[0]);
    positions.emplace_back(fit.poses[k].translation());
    rotations.emplace_back(fit.poses[k].linear());
  }
  return {std::make_unique<SplineCurve>(quintic_chain(natural_spline(positions, at, 3), at)),
          std::make_unique<OrientationSpline>(OrientationSpline::through(rotations, at))};
}

Deviation difference(const ToolCurve& spline, double s, const Pose& wanted) {
  const CurvePoint point = spline.at(std::clamp(s, 0.0, spline.length()));
  return {(point.p - wanted.translation()).norm(),
          rotation_distance(point.rotation, wanted.linear())};
}

bool within(const Deviation& found, const Deviation& tolerance) {
  return found.position <= tolerance.position && found.angle <= tolerance.angle;
}

void check_tolerance(const Deviation& tolerance) {
  if (tolerance.position > 0.0 && tolerance.angle > 0.0) return;
  throw MotionError(ErrorCode::kBadArgument, "the tolerances of a fit must be above zero");
}

[[noreturn]] void refuse(double share, const Deviation& missed) {
  Problem problem;
  problem.code = ErrorCode::kDegenerateCurve;
  problem.share = share;
  problem.value = missed.position;
  char text[200];
  std::snprintf(text, sizeof text,
                "no spline comes within the tolerances of the curve: at %.4f %% of its parameter "
                "the best one still misses it by %.3g m and %.3g rad",
                100.0 * share, missed.position, missed.angle);
  problem.message = text;
  problem.ways_out = {"check whether the curve jumps there", "give a larger tolerance"};
  throw MotionError(std::move(problem));
}

/// A curve that knows its pose at any of its places, for a fit that puts poses where they are
/// needed.
class Fitter {
 public:
  /// What lies inside a span: parameters to look at, and the place to cut it at if it must be.
  struct Inside {
    std::vector<double> places;
    std::optional<double> cut;
  };

  Fitter(std::function<Pose(double)> gamma, std::function<Inside(double, double)> inside,
         const Deviation& tolerance)
      : gamma_(std::move(gamma)), inside_(std::move(inside)), tolerance_(tolerance) {}

  CurveFit run(const std::vector<double>& first) {
    for (const double at : first) fit_.at.push_back(at);
    for (const double at : fit_.at) fit_.poses.push_back(gamma_(at));
    do {
      while (cut(far_turns())) {
      }
    } while (cut(misses()));
    return std::move(fit_);
  }

 private:
  /// Spans whose ends are turned too far apart.
  std::vector<size_t> far_turns() const {
    std::vector<size_t> spans;
    for (size_t k = 0; k + 1 < fit_.at.size(); ++k) {
      const double turn = rotation_distance(fit_.poses[k].linear(), fit_.poses[k + 1].linear());
      if (turn > kMostTurn && inside_(fit_.at[k], fit_.at[k + 1]).cut) spans.push_back(k);
    }
    return spans;
  }

  /// Spans where the spline is too far from the curve; counts anew what was looked at.
  std::vector<size_t> misses() {
    const ToolCurve spline = spline_of(fit_);
    fit_.deviation = {};
    fit_.looked_at = 0;
    std::vector<size_t> spans;
    for (size_t k = 0; k + 1 < fit_.at.size(); ++k) {
      const Inside inside = inside_(fit_.at[k], fit_.at[k + 1]);
      Deviation worst;
      for (const double at : inside.places) {
        const Deviation here = difference(spline, at - fit_.at[0], gamma_(at));
        worst.position = std::max(worst.position, here.position);
        worst.angle = std::max(worst.angle, here.angle);
      }
      fit_.looked_at += inside.places.size();
      fit_.deviation.position = std::max(fit_.deviation.position, worst.position);
      fit_.deviation.angle = std::max(fit_.deviation.angle, worst.angle);
      if (within(worst, tolerance_)) continue;
      if (!inside.cut || fit_.at.size() + spans.size() > kMostPoses) {
        refuse((fit_.at[k] - fit_.at[0]) / (fit_.at.back() - fit_.at[0]), worst);
      }
      spans.push_back(k);
    }
    return spans;
  }

  /// Puts a pose into each of the spans; false where there are none.
  bool cut(const std::vector<size_t>& spans) {
    CurveFit finer;
    size_t next = 0;
    for (size_t k = 0; k < fit_.at.size(); ++k) {
      finer.at.push_back(fit_.at[k]);
      finer.poses.push_back(fit_.poses[k]);
      if (next < spans.size() && spans[next] == k) {
        const double at = *inside_(fit_.at[k], fit_.at[k + 1]).cut;
        finer.at.push_back(at);
        finer.poses.push_back(gamma_(at));
        ++next;
      }
    }
    if (spans.empty()) return false;
    fit_ = std::move(finer);
    return true;
  }

  std::function<Pose(double)> gamma_;
  std::function<Inside(double, double)> inside_;
  Deviation tolerance_;
  CurveFit fit_;
};

}  // namespace

CurveFit fit_curve(const std::function<Pose(double)>& gamma, double from, double to,
                   const Deviation& tolerance) {
  check_tolerance(tolerance);
  if (!(from < to) || !std::isfinite(to - from)) {
    throw MotionError(ErrorCode::kBadArgument, "the range of a curve's parameter must rise");
  }
  const auto inside = [&](double a, double b) {
    Fitter::Inside result;
    for (int i = 0; i < kPlacesInside; ++i) {
      result.places.push_back(a + (b - a) * (i + 0.5) / kPlacesInside);
    }
    if (b - a > kShortestSpan * (to - from)) result.cut = 0.5 * (a + b);
    return result;
  };
  std::vector<double> first;
  for (int i = 0; i <= kFirstSpans; ++i) {
    first.push_back(i == kFirstSpans ? to : from + (to - from) * i / kFirstSpans);
  }
  return Fitter(gamma, inside, tolerance).run(first);
}

CurveFit fit_curve(std::span<const Pose> samples, std::span<const double> at,
                   const Deviation& tolerance) {
  check_tolerance(tolerance);
  if (samples.size() < 2 || samples.size() != at.size()) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::to_string(samples.size()) + " samples at " + std::to_string(at.size()) +
                          " places; a fit needs at least two, each at one place");
  }
  for (size_t k = 1; k < at.size(); ++k) {
    if (at[k] > at[k - 1]) continue;
    throw MotionError(ErrorCode::kBadArgument,
                      "samples " + std::to_string(k - 1) + " and " + std::to_string(k) +
                          " of the curve are at the same place, or in reverse",
                      {"leave one of them out"});
  }
  const auto index_of = [&](double place) {
    return static_cast<size_t>(std::lower_bound(at.begin(), at.end(), place) - at.begin());
  };
  const auto inside = [&](double a, double b) {
    const size_t first = index_of(a);
    const size_t last = index_of(b);
    Fitter::Inside result;
    for (size_t k = first + 1; k < last; ++k) result.places.push_back(at[k]);
    if (last > first + 1) result.cut = at[first + (last - first) / 2];
    return result;
  };
  return Fitter([&](double place) { return samples[index_of(place)]; }, inside, tolerance)
      .run({at.front(), at.back()});
}

}  // namespace viapoint
