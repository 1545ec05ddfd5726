// viapoint-insertion-bench: curves at random on five arms, inserted, and every proof checked on
// 1000 places a piece.
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

/// A straight line to where the joints would be elsewhere; of its position alone where the arm
/// cannot hold more.
std::unique_ptr<TaskCurve> random_line(const Arm& arm, std::mt19937& random,
                                       const JointVector& start, const JointLimits& range) {
  const double spread = 0.05 + 0.5 * std::uniform_real_distribution<double>()(random);
  const JointVector end = start + spread * (testing::random_joints(random, range) - start);
  return std::make_unique<LineCurve>(arm.chain.pose(start), arm.chain.pose(end));
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

void sweep(const Arm& arm, bool lines, int problems) {
  const JointLimits range = testing::range_of(arm.chain);
  InsertionOptions options;
  options.hold = arm.hold;
  Tally tally;
  for (int seed = 0; seed < problems; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const JointVector start = 0.6 * testing::random_joints(random, range);
    const std::unique_ptr<TaskCurve> curve =
        lines ? random_line(arm, random, start, range)
              : testing::random_curve(arm.chain, random, start, arm.hold);
    try {
      const Insertion found = insert_curve(arm.chain, range, *curve, start, options);
      ++tally.inserted;
      tally.pieces += found.pieces.size();
      check(arm, *curve, found, tally);
    } catch (const MotionError& error) {
      ++tally.named[std::string(to_string(error.code()))];
    }
  }
  JsonLine line("insertion", std::string(arm.name) + (lines ? ", lines" : ", curves"));
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

}  // namespace

void bench_insertion(int problems) {
  for (const Arm& arm : arms()) {
    for (const bool lines : {true, false}) sweep(arm, lines, problems);
  }
}

}  // namespace viapoint::bench
