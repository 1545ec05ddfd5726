// Curves at random on five arms, inserted, and every proof checked on 1000 places a piece; and how
// many knots that takes beside Taylor's bisection.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "benches.hpp"
#include "json_line.hpp"
#include "path/random_curves.hpp"
#include "path/teaching_arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint::bench {
namespace {

constexpr int kPlaces = 1000;
/// Lines whose knots are counted, at most.
constexpr int kMostCounted = 400;

struct Arm {
  const char* name;
  ForwardKinematics chain;
  Hold hold;
};

std::vector<Arm> arms() {
  return {{"puma560", testing::puma560(), Hold::kPose},
          {"ur5e", testing::ur5e(), Hold::kPose},
          {"panda", testing::panda(), Hold::kPose},
          {"scara", testing::scara(), Hold::kPose},
          {"rpp", testing::rpp(), Hold::kPosition}};
}

enum class Kind { kLines, kBlindLines, kCurves };

const char* name_of(Kind kind) {
  if (kind == Kind::kLines) return ", lines";
  return kind == Kind::kBlindLines ? ", midpoint blind" : ", curves";
}

JointVector random_end(std::mt19937& random, const JointVector& start, const JointLimits& range) {
  const double spread = 0.05 + 0.5 * std::uniform_real_distribution<double>()(random);
  return start + spread * (testing::random_joints(random, range) - start);
}

/// A straight line to where the joints would be elsewhere; of its position alone where the arm
/// cannot hold more.
LineCurve line_between(const Arm& arm, const JointVector& start, const JointVector& end) {
  return {arm.chain.pose(start), arm.chain.pose(end)};
}

/// How much of the error that a straight joint motion makes at a quarter of the line is there in
/// the middle, where Taylor's test looks; less than all only where the error changes its side.
double seen_in_the_middle(const Arm& arm, const JointVector& start, const JointVector& end) {
  const LineCurve line = line_between(arm, start, end);
  const auto error = [&](double share) {
    const Pose pose = arm.chain.pose(start + share * (end - start));
    return (pose.translation() - line.at(share * line.length()).p).norm();
  };
  return error(0.5) / std::max({error(0.25), error(0.75), 1e-6});
}

/// Of many ends, the one to which the midpoint tells least.
JointVector blind_end(const Arm& arm, std::mt19937& random, const JointVector& start,
                      const JointLimits& range) {
  constexpr int kEnds = 50;
  JointVector blindest = random_end(random, start, range);
  double least = seen_in_the_middle(arm, start, blindest);
  for (int k = 1; k < kEnds; ++k) {
    const JointVector end = random_end(random, start, range);
    const double seen = seen_in_the_middle(arm, start, end);
    if (seen >= least) continue;
    least = seen;
    blindest = end;
  }
  return blindest;
}

std::unique_ptr<TaskCurve> random_curve(const Arm& arm, Kind kind, std::mt19937& random,
                                        const JointVector& start, const JointLimits& range) {
  if (kind == Kind::kCurves) return testing::random_curve(arm.chain, random, start, arm.hold);
  const JointVector end = kind == Kind::kLines ? random_end(random, start, range)
                                               : blind_end(arm, random, start, range);
  return std::make_unique<LineCurve>(line_between(arm, start, end));
}

/// What a sweep found.
struct Tally {
  int inserted = 0;
  size_t pieces = 0;
  size_t broken = 0;                 ///< places beyond what was proven
  double worst = 0.0;                ///< largest deviation found, as a share of the proven one
  std::map<std::string, int> named;  ///< refusals by their code
};

/// Looks at the pieces and counts the places that are farther from the curve than proven.
void check(const Arm& arm, const TaskCurve& curve, const Insertion& found, Tally& tally) {
  constexpr double kRounding = 1e-13;
  double s0 = 0.0;
  for (const JointPiece& piece : found.pieces) {
    for (int i = 0; i <= kPlaces; ++i) {
      const double s = piece.length * i / kPlaces;
      const Pose pose = arm.chain.pose(piece.at(s).q);
      const CurvePoint wanted = curve.at(std::min(s0 + s, curve.length()));
      const double off = (pose.translation() - wanted.p).norm();
      const double turned =
          arm.hold == Hold::kPose ? rotation_distance(wanted.rotation, pose.linear()) : 0.0;
      if (!(off <= piece.position_deviation + kRounding) ||
          !(turned <= piece.angle_deviation + kRounding)) {
        ++tally.broken;
      }
      if (piece.position_deviation > 1e-9) {
        tally.worst = std::max(tally.worst, off / piece.position_deviation);
      }
    }
    s0 += piece.length;
  }
}

void sweep(const Arm& arm, Kind kind, int problems) {
  const JointLimits range = testing::range_of(arm.chain);
  InsertionOptions options;
  options.hold = arm.hold;
  Tally tally;
  for (int seed = 0; seed < problems; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const JointVector start = 0.6 * testing::random_joints(random, range);
    const std::unique_ptr<TaskCurve> curve = random_curve(arm, kind, random, start, range);
    try {
      const Insertion found = insert_curve(arm.chain, range, *curve, start, options);
      ++tally.inserted;
      tally.pieces += found.pieces.size();
      check(arm, *curve, found, tally);
    } catch (const MotionError& error) {
      ++tally.named[std::string(to_string(error.code()))];
    }
  }
  JsonLine line("insertion", std::string(arm.name) + name_of(kind));
  line.add("problems", problems)
      .add("inserted", tally.inserted)
      .add("pieces", tally.pieces)
      .add("places", tally.pieces * (kPlaces + 1))
      .add("places_beyond_the_proof", tally.broken)
      .add("largest_share_of_the_proof", tally.worst);
  // Every row has every column: what is refused at all is one of these.
  for (const ErrorCode code : {ErrorCode::kJointLimit, ErrorCode::kUnreachable,
                               ErrorCode::kSingular, ErrorCode::kUncontrolled}) {
    const std::string name(to_string(code));
    line.add(name, tally.named[name]);
  }
}

/// Knots of the same lines by both methods, and how far Taylor's joint lines really are off.
void count_knots(const Arm& arm, double tolerance, int problems) {
  const JointLimits range = testing::range_of(arm.chain);
  InsertionOptions options;
  options.position_tolerance = tolerance;
  options.angle_tolerance = tolerance / 0.3;
  int lines = 0;
  size_t ours = 0, taylors = 0;
  double worst = 0.0;
  for (int seed = 0; seed < problems; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const JointVector start = 0.6 * testing::random_joints(random, range);
    const LineCurve curve = line_between(arm, start, random_end(random, start, range));
    try {
      const Insertion found = insert_curve(arm.chain, range, curve, start, options);
      const TaylorKnots taylor = taylor_insertion(arm.chain, curve, start, found.knots.back(),
                                                  tolerance, options.angle_tolerance);
      ++lines;
      ours += found.knots.size();
      taylors += taylor.knots.size();
      for (size_t k = 0; k + 1 < taylor.knots.size(); ++k) {
        const JointPiece piece =
            JointPiece::line(taylor.knots[k], taylor.knots[k + 1], taylor.s[k + 1] - taylor.s[k]);
        const Deviation truth = bound_deviation(arm.chain, piece, curve, taylor.s[k],
                                                0.02 * tolerance, 0.02 * options.angle_tolerance);
        worst =
            std::max({worst, truth.position / tolerance, truth.angle / options.angle_tolerance});
      }
    } catch (const MotionError&) {
      continue;  // what cannot be followed has no knots
    }
  }
  JsonLine("insertion: knots",
           std::string(arm.name) + ", " + std::to_string(1e3 * tolerance).substr(0, 4) + " mm")
      .add("lines", lines)
      .add("knots", ours)
      .add("taylor_knots", taylors)
      .add("share_of_taylor", static_cast<double>(ours) / static_cast<double>(taylors))
      .add("taylor_worst_over_tolerance", worst);
}

}  // namespace

void bench_insertion(int problems) {
  for (const Arm& arm : arms()) {
    for (const Kind kind : {Kind::kLines, Kind::kBlindLines, Kind::kCurves}) {
      sweep(arm, kind, problems);
    }
  }
  for (const Arm& arm : arms()) {
    if (arm.hold != Hold::kPose) continue;  // Taylor's method is one of poses
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
      count_knots(arm, tolerance, std::min(problems, kMostCounted));
    }
  }
}

}  // namespace viapoint::bench
