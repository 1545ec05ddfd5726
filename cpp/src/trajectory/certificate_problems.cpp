#include "trajectory/certificate_problems.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

namespace viapoint {
namespace {

/// Step of position, and distance beyond a position limit, that counts as rounding: this much [rad
/// or m], or so many ε of the position where that is more. (Bounds of positions include 32 ε.)
constexpr double kPositionSlack = 1e-9;
constexpr double kStepUnits = 8.0, kPositionUnits = 64.0;
/// Step of velocity and acceleration, and what an end at rest may have, as a share of the limit.
constexpr double kRateStep = 1e-6;

double rounding(double size, double units) {
  const double relative = units * std::numeric_limits<double>::epsilon() * std::abs(size);
  return std::isfinite(relative) ? std::max(kPositionSlack, relative) : kPositionSlack;
}

/// Which problems come before which, whatever their size.
enum class Rank { kStep, kEnd, kPosition, kRate };

/// A problem, and by how much it is one: compared within its rank only.
struct Ranked {
  Rank rank;
  double severity;
  Problem problem;
};

struct Quantity {
  std::string_view name;
  std::string_view unit;
  ErrorCode code;
};
constexpr Quantity kPosition{"position", "rad or m", ErrorCode::kJointLimit};
constexpr Quantity kVelocity{"velocity", "rad/s or m/s", ErrorCode::kVelocityLimit};
constexpr Quantity kAcceleration{"acceleration", "rad/s² or m/s²", ErrorCode::kAccelerationLimit};
constexpr Quantity kJerk{"jerk", "rad/s³ or m/s³", ErrorCode::kJerkLimit};

Problem make_problem(ErrorCode code, std::string message, std::string way_out, const Worst& worst,
                     double limit, std::optional<int> joint) {
  Problem problem;
  problem.code = code;
  problem.message = std::move(message);
  problem.ways_out = {std::move(way_out)};
  problem.move = worst.move;
  problem.joint = joint;
  problem.time = worst.time;
  problem.value = worst.value;
  problem.limit = limit;
  return problem;
}

class Collector {
 public:
  void rate(const Quantity& what, int joint, const Extremum& worst, double limit) {
    // Written so that NaN is a problem, here and below.
    if (worst.share <= 1.0 + kLimitSlack) return;
    std::ostringstream text;
    text << "the " << what.name << " of joint " << joint + 1 << " reaches " << worst.value << " at "
         << worst.time << " s; allowed is at most " << limit << ' ' << what.unit;
    add(Rank::kRate, worst.share,
        make_problem(what.code, text.str(), "give the move more time: a lower speed or scale",
                     {worst.value, worst.time, worst.move}, limit, joint));
  }

  void position(const std::string& who, ErrorCode code, const Worst& worst, double limit,
                double outside, std::optional<int> joint) {
    if (outside <= rounding(limit, kPositionUnits)) return;
    std::ostringstream text;
    text << who << " comes to " << worst.value << " at " << worst.time << " s, " << outside
         << " beyond its limit of " << limit << ' ' << kPosition.unit;
    add(Rank::kPosition, outside,
        make_problem(code, text.str(), "choose points and a way between them inside the limits",
                     worst, limit, joint));
  }

  void step(const Quantity& what, int joint, const Worst& worst, double allowed) {
    if (worst.value <= allowed) return;
    std::ostringstream text;
    text << "the " << what.name << " of joint " << joint + 1 << " steps by " << worst.value
         << " between two pieces at " << worst.time << " s; rounding explains at most " << allowed
         << ' ' << what.unit;
    add(Rank::kStep, worst.value / allowed,
        make_problem(ErrorCode::kDiscontinuous, text.str(),
                     "use pieces that meet in position, velocity and acceleration", worst, allowed,
                     joint));
  }

  void rest(const Quantity& what, std::string_view end, int joint, const Worst& worst,
            double allowed) {
    if (worst.value <= allowed) return;
    std::ostringstream text;
    text << "the motion " << end << " with a " << what.name << " of " << worst.value << ' '
         << what.unit << " at joint " << joint + 1 << "; it must be at rest there";
    add(Rank::kEnd, worst.value / allowed,
        make_problem(ErrorCode::kNotAtRest, text.str(), "let the motion begin and end at rest",
                     worst, 0.0, joint));
  }

  std::vector<Problem> sorted(std::vector<Problem> first) && {
    std::ranges::sort(found_, [](const Ranked& a, const Ranked& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.severity > b.severity;
    });
    for (Ranked& ranked : found_) first.push_back(std::move(ranked.problem));
    return first;
  }

 private:
  void add(Rank rank, double severity, Problem problem) {
    found_.push_back({rank, severity, std::move(problem)});
  }

  std::vector<Ranked> found_;
};

}  // namespace

double explained_step(double size) { return rounding(size, kStepUnits); }

std::vector<Problem> find_problems(const Certificate& certificate, const Findings& findings,
                                   const JointLimits& limits) {
  Collector found;
  for (int i = 0; i < limits.joints(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const JointStates& jump = findings.jumps[at];
    found.step(kPosition, i, findings.steps[at].worst, findings.steps[at].explained);
    found.step(kVelocity, i, jump.velocity, kRateStep * limits.velocity[i]);
    found.step(kAcceleration, i, jump.acceleration, kRateStep * limits.acceleration[i]);

    for (const auto& [end, name] :
         {std::pair{&findings.start[at], "starts"}, std::pair{&findings.end[at], "ends"}}) {
      found.rest(kVelocity, name, i, end->velocity, kRateStep * limits.velocity[i]);
      found.rest(kAcceleration, name, i, end->acceleration, kRateStep * limits.acceleration[i]);
    }

    const std::string who = "joint " + std::to_string(i + 1);
    const Worst& low = findings.lowest[at];
    const Worst& high = findings.highest[at];
    found.position(who, ErrorCode::kJointLimit, low, limits.position_min[i],
                   limits.position_min[i] - low.value, i);
    found.position(who, ErrorCode::kJointLimit, high, limits.position_max[i],
                   high.value - limits.position_max[i], i);

    found.rate(kVelocity, i, certificate.velocity[at], limits.velocity[i]);
    found.rate(kAcceleration, i, certificate.acceleration[at], limits.acceleration[i]);
    found.rate(kJerk, i, certificate.jerk[at], limits.jerk[i]);
  }
  for (int row = 0; row < limits.couplings(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const std::string who = "coupled limit " + std::to_string(row + 1);
    const Worst& low = findings.coupling_low[at];
    const Worst& high = findings.coupling_high[at];
    found.position(who, ErrorCode::kCouplingLimit, low, limits.coupling_lower[row],
                   limits.coupling_lower[row] - low.value, std::nullopt);
    found.position(who, ErrorCode::kCouplingLimit, high, limits.coupling_upper[row],
                   high.value - limits.coupling_upper[row], std::nullopt);
  }
  return std::move(found).sorted(findings.malformed);
}

}  // namespace viapoint
