// A plain C face on path timing for tools/bench: called from Python next to its peers, on the very
// same path.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <limits>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/reachability_timing.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace {

using namespace viapoint;

/// A jerk limit that nothing here comes near to.
constexpr double kAnyJerk = 1e12;
constexpr double kAnywhere = 1e3;

JointLimits limits_of(const double* rates, int joints, bool with_jerk) {
  JointLimits limits;
  const auto row = [&](int k) {
    return Eigen::Map<const Eigen::VectorXd>(rates + std::ptrdiff_t{k} * joints, joints);
  };
  limits.position_min = JointVector::Constant(joints, -kAnywhere);
  limits.position_max = JointVector::Constant(joints, kAnywhere);
  limits.velocity = row(0);
  limits.acceleration = row(1);
  limits.jerk = row(2);
  if (!with_jerk) limits.jerk.setConstant(kAnyJerk);
  limits.coupling.resize(0, joints);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return limits;
}

JointPath path_of(const double* coefficients, int pieces, int joints) {
  JointPath path;
  for (int k = 0; k < pieces; ++k) {
    JointPiece piece;
    piece.kind = PieceKind::kCurve;
    piece.length = 1.0;
    piece.coefficients =
        Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>(
            coefficients + std::ptrdiff_t{6} * k * joints, 6, joints);
    path.append(piece);
  }
  return path;
}

double largest(const std::vector<Extremum>& extrema) {
  double most = 0.0;
  for (const Extremum& extremum : extrema) most = std::max(most, extremum.share);
  return most;
}

void note(const Certificate& certificate, double duration, double* result) {
  result[0] = duration;
  result[1] = largest(certificate.velocity);
  result[2] = largest(certificate.acceleration);
  result[3] = largest(certificate.jerk);
}

/// Seconds that the quickest of `repeats` calls takes.
template <typename Call>
double quickest(int repeats, const Call& call) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const auto begin = Clock::now();
    call();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return best;
}

}  // namespace

/// Times a path. @param coefficients of q by u^0 … u^5 of every piece, (pieces, 6, joints), equal
///   q' by u at knots
/// @param rates limits of velocity, acceleration and jerk, (3, joints)
/// @param cells of each piece where jerk does not count; 0: jerk counts
/// @param result duration [s], or −1 where there is none, and the proven shares of the limits, (4,)
/// @return the time of the quickest of `repeats` timings [s]
extern "C" double viapoint_time_path(const double* coefficients, int pieces, int joints,
                                     const double* rates, int cells, int repeats, double* result) {
  result[0] = -1.0;
  try {
    const JointPath path = path_of(coefficients, pieces, joints);
    const JointLimits limits = limits_of(rates, joints, cells == 0);
    std::vector<TrajectoryPiece> motion;
    const double best = quickest(repeats, [&] {
      motion =
          cells == 0 ? parameterize(path, limits) : parameterize_without_jerk(path, limits, cells);
    });
    double duration = 0.0;
    for (const TrajectoryPiece& piece : motion) duration += piece.duration;
    note(certify(motion, limits), duration, result);
    return best;
  } catch (const MotionError& error) {
    std::cerr << "viapoint: " << error.what() << '\n';
    return std::numeric_limits<double>::quiet_NaN();
  }
}

/// Plans a motion straight from point to point, corners within `deviation` in joint space (0: with
/// stops), with its proof. @param points (count, joints); the others as above
extern "C" double viapoint_time_walk(const double* points, int count, int joints,
                                     const double* rates, double deviation, int repeats,
                                     double* result) {
  result[0] = -1.0;
  try {
    const auto point = [&](int k) -> JointVector {
      return Eigen::Map<const Eigen::VectorXd>(points + std::ptrdiff_t{k} * joints, joints);
    };
    const MotionPlanner planner(RobotModel::joint_robot(limits_of(rates, joints, true)));
    MotionProgram program;
    program.start = point(0);
    for (int k = 1; k < count; ++k) {
      Step& step = program.steps.emplace_back();
      step.what = PtpMove{JointTarget{point(k)}};
      if (deviation > 0.0) step.options.zone = {ZoneKind::kJointDeviation, deviation};
    }
    PlannedMotion planned;
    const double best = quickest(repeats, [&] { planned = planner.plan(program); });
    note(planned.trajectory.certificate(), planned.trajectory.duration(), result);
    return best;
  } catch (const MotionError& error) {
    std::cerr << "viapoint: " << error.what() << '\n';
    return std::numeric_limits<double>::quiet_NaN();
  }
}
