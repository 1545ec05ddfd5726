#include "viapoint/trajectory/time_parameterizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "trajectory/path_timing_barrier.hpp"
#include "trajectory/path_timing_grid.hpp"
#include "trajectory/path_timing_hold.hpp"
#include "trajectory/path_timing_range.hpp"
#include "trajectory/path_timing_span.hpp"
#include "trajectory/path_timing_uniform.hpp"
#include "trajectory/path_timing_valid.hpp"

namespace viapoint {
namespace path_timing {
namespace {

/// How much of what is proven may be slack, relative.
constexpr double kProofSlack = 1e-4, kExact = 1e-12;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// A proof that costs no more than this leaves nothing to look for.
constexpr double kGoodEnough = 1.02;
/// A hair more than the bound, against the rounding of whoever checks the result.
constexpr double kMargin = 1.0 + 1e-12;

/// What the limits of each cell must be multiplied by for the motion, as proven, to use as much of
/// them as the optimiser meant to.
/// @param most share of its limits that the present motion may use in the optimiser's eyes
/// @param aim share of the limits that the motion is to use
std::vector<Shares> corrections(const BarrierProblem& problem, const SquareRate& rate,
                                const Course& course, const std::vector<TimedSpan>& spans,
                                double most, double aim) {
  constexpr int kCells = 4;
  constexpr double kSlack = 1e-2;
  constexpr double kOfInterest = 0.3, kLeast = 0.3, kMost = 1.1;
  const auto factor = [=](double model, double real, double now) {
    const bool counts = real >= kOfInterest && model >= 0.5 * kOfInterest;
    return counts ? std::max(std::clamp(model / real, kLeast, kMost), model / most) : now;
  };
  const std::vector<Shares> meant = problem.shares(rate);
  std::vector<Shares> factors;
  factors.reserve(spans.size());
  for (size_t k = 0; k < spans.size(); ++k) {
    const Shares real = bound_shares(course, spans[k], kCells, kSlack).proven;
    const Shares now = problem.limit_factors(k);
    const double by_velocity = real.velocity > aim ? aim : 1.0;
    factors.push_back(
        {by_velocity * std::min(1.0, factor(meant[k].velocity, real.velocity, now.velocity)),
         aim * factor(meant[k].acceleration, real.acceleration, now.acceleration),
         aim * factor(meant[k].jerk, real.jerk, now.jerk)});
  }
  return factors;
}

/// A proven timing.
struct Timing {
  std::vector<TimedSpan> spans;
  double stretch = kInfinite;  ///< what the proof cost, as a factor on time
};

/// Cells in which the motion is much worse than the optimiser meant.
std::vector<bool> too_coarse(const Course& course, const std::vector<TimedSpan>& spans) {
  constexpr int kCells = 8;
  std::vector<bool> coarse;
  for (const TimedSpan& span : spans) {
    const double stretch = bound_shares(course, span, kCells, kProofSlack).reached.stretch();
    coarse.push_back(!goes_forward(span) || !(stretch <= kGoodEnough));
  }
  return coarse;
}

/// Where the tool is to keep a speed, it should be near it: the barriers of the ceilings get less
/// and less weight.
bool press_on_ceilings(BarrierProblem& problem, SquareRate& rate, double weight, double least) {
  for (double share = 0.2; share > least; share *= 0.2) {
    problem.set_ceiling_weight(share);
    if (!problem.solve(rate, weight, weight)) return false;
  }
  return true;
}

/// The motion, with the speed held exactly where that breaks no limit beside it.
std::vector<TimedSpan> hold_where_it_fits(const Course& course, const BarrierProblem& problem,
                                          const SquareRate& rate) {
  constexpr int kCells = 16, kMostRounds = 12;
  std::vector<bool> held = problem.held_cells(rate);
  std::vector<TimedSpan> spans = problem.spans(rate, held);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<bool> before = held;
    for (size_t k = 0; k < spans.size(); ++k) {
      const size_t first = k > 0 ? k - 1 : k, last = std::min(k + 1, spans.size() - 1);
      const bool beside = before[first] || before[k] || before[last];
      if (!beside || bound_shares(course, spans[k], kCells, kProofSlack).proven.stretch() <= 1.0) {
        continue;
      }
      held[first] = held[k] = held[last] = false;
    }
    if (held == before) break;
    spans = problem.spans(rate, held);
  }
  return spans;
}

/// The motion that `rate` is, stretched to what is proven.
Timing proven(const Course& course, const BarrierProblem& problem, const SquareRate& rate) {
  const bool holds = course.holds_speed();
  Timing timing{holds ? hold_where_it_fits(course, problem, rate) : problem.spans(rate), kInfinite};
  if (!std::all_of(timing.spans.begin(), timing.spans.end(), goes_forward)) return timing;
  timing.stretch = prove(course, timing.spans, kProofSlack).stretch();
  if (holds) {
    timing.stretch = std::max(timing.stretch, largest_held_speed(course, timing.spans));
    if (timing.stretch <= 1.0) return timing;
  }
  stretch_time(timing.spans, timing.stretch * kMargin);
  return timing;
}

void keep_better(Timing& best, const Timing& timing) {
  if (!std::isfinite(timing.stretch)) return;
  if (best.spans.empty() || total_duration(timing.spans) < total_duration(best.spans))
    best = timing;
}

/// Limits of the cells where the motion, as proven, exceeds them are lowered by that much, and the
/// optimum is sought anew from beside the one that is there. False if the numbers gave out.
bool mend(BarrierProblem& problem, SquareRate& rate, const Course& course, double weight) {
  constexpr int kCells = 16;
  // The whole motion slowed down by a per cent or two is about what a little more weight would
  // make.
  constexpr double kRoom = 0.995, kCloseBy = 3.0;
  const std::vector<TimedSpan> spans = problem.spans(rate);
  std::vector<Shares> factors;
  factors.reserve(spans.size());
  const auto lowered = [](double factor, double share) { return factor / std::max(1.0, share); };
  for (size_t k = 0; k < spans.size(); ++k) {
    const Shares real = bound_shares(course, spans[k], kCells, kProofSlack).proven;
    const Shares now = problem.limit_factors(k);
    factors.push_back({lowered(now.velocity, real.velocity),
                       lowered(now.acceleration, real.acceleration), lowered(now.jerk, real.jerk)});
  }
  problem.set_limit_factors(factors);
  problem.make_feasible(rate, 0, kRoom);
  return problem.solve(rate, kCloseBy * weight, weight);
}

/// The near-optimal timing; empty if the method does not get there.
Timing quickest(const Course& course) {
  constexpr double kFirstWeight = 0.1, kLastWeight = 0.006;
  constexpr int kMostPasses = 6;
  constexpr int kMostMendings = 2;
  constexpr double kWorthMending = 1.01, kBeyondMending = 1.2;
  constexpr double kUsed = 0.99;
  // Time cannot be stretched where a speed is held: there the motion is to come out below its
  // limits, by more with every pass that fails.
  constexpr double kAim = 0.98, kPressed = 0.03, kHeld = 1e-5;
  const bool holds = course.holds_speed();
  const double good_enough = holds ? 1.0 : kGoodEnough;
  double aim = holds ? kAim : 1.0;
  Grid grid = make_grid(course);
  if (grid.cells.empty()) return {};
  if (holds) grid = refine_to_hold(course, std::move(grid));
  std::optional<BarrierProblem> problem(std::in_place, course, grid);
  SquareRate rate = problem->start();
  bool solved = problem->solve(rate, kFirstWeight, kFirstWeight);
  Timing best;
  for (int pass = 1;; ++pass) {
    // The optimiser sees limits at a few places of a cell and b as a cubic in s; the motion is a
    // quintic in time and held to its limits everywhere. Where the two differ, the limits given to
    // the optimiser are corrected while it still keeps its distance from them.
    problem->set_limit_factors(
        corrections(*problem, rate, course, problem->spans(rate), kUsed, aim));
    if (holds) problem->make_feasible(rate, 5, kUsed);
    // What it has when the numbers give out is a motion too.
    solved = solved && problem->solve(rate, kFirstWeight, kLastWeight);
    if (course.limits_tool())
      solved = solved && press_on_ceilings(*problem, rate, kLastWeight, holds ? kHeld : kPressed);
    Timing timing = proven(course, *problem, rate);
    if (holds && timing.stretch <= 1.0) return timing;
    keep_better(best, timing);
    if (timing.stretch <= good_enough || pass == kMostPasses || !solved) {
      for (int round = 0; round < kMostMendings && !holds && solved; ++round) {
        if (timing.stretch <= kWorthMending || timing.stretch > kBeyondMending) break;
        solved = mend(*problem, rate, course, kLastWeight);
        timing = proven(course, *problem, rate);
        keep_better(best, timing);
      }
      return best;
    }
    if (holds) aim *= kAim;
    // Where a correction does not help enough, cells are too long.
    grid = refine(grid, too_coarse(course, problem->spans(rate)), rate);
    problem.emplace(course, grid);
    if (holds) {
      rate = problem->start();
    } else {
      problem->make_feasible(rate, 0, kFeasibleRoom);
    }
    solved = problem->solve(rate, kFirstWeight, kFirstWeight);
  }
}

TimedPath to_timed_path(const JointPath& path, const std::vector<TimedSpan>& spans) {
  TimedPath timed{to_pieces(path, spans), {}};
  timed.origin.reserve(spans.size());
  for (const TimedSpan& span : spans) timed.origin.push_back(span.piece);
  return timed;
}

/// Seven phases under bounds that hold all along the section.
std::vector<TimedSpan> slowest(const Course& course, const JointLimits& limits,
                               std::span<const ToolRates> tool) {
  const JointPath path = course.in_one_scale();
  // The ceilings are bounds already, so proof can only shorten what they give.
  auto spans = seven_phases(path, within_range(uniform_ceilings(path, limits, tool), path, limits));
  const double proven =
      std::max(prove(course, spans, kProofSlack).stretch(), largest_held_speed(course, spans));
  stretch_time(spans, std::min(1.0, kMargin * proven));
  return spans;
}

}  // namespace
}  // namespace path_timing

TimedPath parameterize(const JointPath& path, const JointLimits& limits,
                       std::span<const ToolRates> tool) {
  using namespace path_timing;
  require_valid(path, limits);
  const Course course(path, limits, tool);
  if (const auto ceilings = course.limits_tool() ? std::nullopt : straight_ceilings(path, limits)) {
    auto spans = seven_phases(path, within_range(*ceilings, path, limits));
    stretch_time(spans, prove(course, spans, kExact).stretch() * kMargin);
    return to_timed_path(path, spans);
  }
  Timing quick = quickest(course);
  const double duration = total_duration(quick.spans);
  if (quick.stretch <= kGoodEnough && in_range(duration)) {
    return to_timed_path(path, quick.spans);
  }
  auto spans = slowest(course, limits, tool);
  if (std::isfinite(quick.stretch) && duration < total_duration(spans)) {
    spans = std::move(quick.spans);
  }
  return to_timed_path(path, spans);
}

std::vector<TrajectoryPiece> parameterize(const JointPath& path, const JointLimits& limits) {
  return parameterize(path, limits, {}).pieces;
}

}  // namespace viapoint
