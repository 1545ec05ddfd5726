#include "viapoint/trajectory/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "trajectory/certificate_problems.hpp"
#include "trajectory/piece_proof.hpp"
#include "trajectory/trajectory_piece_check.hpp"
#include "viapoint/trajectory/bernstein.hpp"
#include "viapoint/trajectory/bernstein_composition.hpp"

namespace viapoint {
namespace {

/// Gap allowed between what is reached and what is proven: a share of the limit for rates, in rad
/// or m for positions. Leaves a factor of ten to the 1e-9 that Extremum promises.
constexpr double kTightness = 1e-10;
/// How far u may leave [0, 1] through rounding.
constexpr double kTimingSlack = 1e-9;

/// A peak over the whole motion, with its place.
struct PlacedPeak {
  Peak peak;
  double time = 0.0;
  int move = 0;
};

/// Peaks of one joint.
struct JointPeaks {
  PlacedPeak highest, lowest;  ///< lowest: of -q
  std::array<PlacedPeak, 3> rates;
};

class Walk {
 public:
  explicit Walk(const JointLimits& limits)
      : limits_(limits),
        joints_(static_cast<std::size_t>(limits.joints())),
        peaks_(joints_),
        coupling_high_(static_cast<std::size_t>(limits.couplings())),
        coupling_low_(static_cast<std::size_t>(limits.couplings())) {
    findings_.jumps.resize(joints_);
    findings_.steps.resize(joints_);
    sizes_.resize(joints_);
    findings_.start.resize(joints_);
    findings_.end.resize(joints_);
    for (JointPeaks& joint : peaks_) {
      // Standing still is always reached.
      for (PlacedPeak& rate : joint.rates) rate.peak = {0.0, 0.0};
    }
  }

  /// The first piece goes on from this state.
  void go_on_from(const JointState& state) {
    before_ = state;
    started_ = true;
  }

  void add(const TrajectoryPiece& piece, std::size_t index) {
    if (const auto fault = find_fault(piece, limits_.joints())) {
      report(piece, index, *fault);
      before_.reset();
      return;
    }
    const PieceProof proof(piece);
    check_timing(proof, piece, index);
    for (std::size_t i = 0; i < joints_; ++i) add_joint(proof, piece, i);
    for (int row = 0; row < limits_.couplings(); ++row) add_coupling(proof, piece, row);
    join(piece);
    time_ += piece.duration;
  }

  Certificate finish() && {
    if (before_) note_end(*before_, time_, last_move_, findings_.end);
    Certificate certificate;
    gather(certificate);
    certificate.problems = find_problems(certificate, findings_, limits_);
    return certificate;
  }

 private:
  void report(const TrajectoryPiece& piece, std::size_t index, const std::string& reason) {
    Problem problem;
    problem.code = ErrorCode::kBadArgument;
    problem.message = "piece " + std::to_string(index) + " of the motion " + reason;
    problem.ways_out = {"rebuild the motion: this piece cannot be run"};
    problem.move = piece.move;
    problem.time = time_;
    findings_.malformed.push_back(std::move(problem));
  }

  void check_timing(const PieceProof& proof, const TrajectoryPiece& piece, std::size_t index) {
    if (proof.timing_in_range()) return;
    const BernsteinPolynomial u = proof.composition().timing();
    // Shifted so that both excesses are peaks above what is allowed anyhow.
    Peak high{1.0, 1.0};
    Peak low{0.0, 0.0};
    raise(high, u, 0.1 * kTimingSlack);
    raise(low, -u, 0.1 * kTimingSlack);
    if (high.bound <= 1.0 + kTimingSlack && low.bound <= kTimingSlack) return;
    std::ostringstream text;
    text << "has a timing u(x) between " << -low.bound << " and " << high.bound
         << "; it must stay in [0, 1]";
    report(piece, index, text.str());
  }

  void take(PlacedPeak& peak, const BernsteinPolynomial& f, double tolerance, double rounding,
            const TrajectoryPiece& piece) {
    if (const auto x = raise(peak.peak, f, tolerance, rounding)) {
      peak.time = time_ + *x * piece.duration;
      peak.move = piece.move;
    }
  }

  void add_joint(const PieceProof& proof, const TrajectoryPiece& piece, std::size_t i) {
    BernsteinComposition::Path path;
    for (std::size_t k = 0; k < 6; ++k) path[k] = piece.path[k][i];

    JointPeaks& joint = peaks_[i];
    add_range(proof, path, piece, joint.highest, joint.lowest);
    const auto at = static_cast<Eigen::Index>(i);
    const std::array<double, 3> limit = {limits_.velocity[at], limits_.acceleration[at],
                                         limits_.jerk[at]};
    std::array<double, 3> tolerance{}, enough{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double reached = joint.rates[d].peak.reached;
      tolerance[d] = kTightness * std::max(limit[d], reached);
      enough[d] = reached * (1.0 + kTightness);
    }
    const BernsteinComposition& composition = proof.composition();
    for (std::size_t d = 0; d < 3; ++d) {
      PlacedPeak& rate = joint.rates[d];
      const int order = static_cast<int>(d) + 1;
      const double rounding = composition.rounding(path, order);
      const double bound = composition.magnitude(path, order) + rounding;
      if (bound <= enough[d]) {
        rate.peak.bound = std::max(rate.peak.bound, bound);
        continue;
      }
      const BernsteinPolynomial f = composition.of(path, order);
      take(rate, f, tolerance[d], rounding, piece);
      take(rate, -f, tolerance[d], rounding, piece);
    }
  }

  void add_range(const PieceProof& proof, const BernsteinComposition::Path& path,
                 const TrajectoryPiece& piece, PlacedPeak& highest, PlacedPeak& lowest) {
    if (proof.within(path, -lowest.peak.reached, highest.peak.reached)) return;
    const auto [q, rounding] = proof.same_range(path);
    take(highest, q, kTightness, rounding, piece);
    take(lowest, -q, kTightness, rounding, piece);
  }

  void add_coupling(const PieceProof& proof, const TrajectoryPiece& piece, int row) {
    BernsteinComposition::Path path{};
    for (std::size_t k = 0; k < 6; ++k) {
      for (int i = 0; i < limits_.joints(); ++i) {
        path[k] += limits_.coupling(row, i) * piece.path[k][static_cast<std::size_t>(i)];
      }
    }
    const auto at = static_cast<std::size_t>(row);
    add_range(proof, path, piece, coupling_high_[at], coupling_low_[at]);
  }

  /// Compares the start of `piece` with the end of the one before.
  void join(const TrajectoryPiece& piece) {
    const JointState now = piece.at(0.0);
    if (!started_) note_end(now, time_, piece.move, findings_.start);
    started_ = true;
    if (before_) {
      for (std::size_t i = 0; i < joints_; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        JointStates& jump = findings_.jumps[i];
        note(jump.position, now.q[at] - before_->q[at], time_, piece.move);
        note_step(findings_.steps[i], now.q[at] - before_->q[at],
                  explained_step(std::max(sizes_[i], size_of(piece, i))), piece.move);
        note(jump.velocity, now.qd[at] - before_->qd[at], time_, piece.move);
        note(jump.acceleration, now.qdd[at] - before_->qdd[at], time_, piece.move);
      }
    }
    before_ = piece.at(piece.duration);
    for (std::size_t i = 0; i < joints_; ++i) sizes_[i] = size_of(piece, i);
    last_move_ = piece.move;
  }

  /// What the rounding of q(u) is in proportion to: the terms it is the sum of.
  static double size_of(const TrajectoryPiece& piece, std::size_t joint) {
    double sum = 0.0;
    for (const auto& coefficients : piece.path) sum += std::abs(coefficients[joint]);
    return sum;
  }

  void note_step(PositionStep& most, double step, double explained, int move) const {
    if (std::isnan(most.worst.value)) return;
    const bool first = most.explained == 0.0;
    if (!first && std::abs(step) * most.explained <= most.worst.value * explained) return;
    most = {{std::abs(step), time_, move}, explained};
  }

  static void note(Worst& worst, double step, double time, int move) {
    // Written so that NaN is kept once it is there.
    if (std::isnan(worst.value) || std::abs(step) <= worst.value) return;
    worst = {std::abs(step), time, move};
  }

  static void note_end(const JointState& state, double time, int move,
                       std::vector<JointStates>& joints) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      note(joints[i].velocity, state.qd[at], time, move);
      note(joints[i].acceleration, state.qdd[at], time, move);
    }
  }

  void gather(Certificate& certificate) {
    certificate.position_min.resize(limits_.joints());
    certificate.position_max.resize(limits_.joints());
    for (std::size_t i = 0; i < joints_; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const JointPeaks& joint = peaks_[i];
      certificate.velocity.push_back(extremum(joint.rates[0], limits_.velocity[at]));
      certificate.acceleration.push_back(extremum(joint.rates[1], limits_.acceleration[at]));
      certificate.jerk.push_back(extremum(joint.rates[2], limits_.jerk[at]));
      findings_.highest.push_back(worst(joint.highest, 1.0));
      findings_.lowest.push_back(worst(joint.lowest, -1.0));
      certificate.position_max[at] = findings_.highest[i].value;
      certificate.position_min[at] = findings_.lowest[i].value;

      const JointStates& jump = findings_.jumps[i];
      raise_to(certificate.position_jump, jump.position);
      raise_to(certificate.velocity_jump, jump.velocity);
      raise_to(certificate.acceleration_jump, jump.acceleration);
      raise_to(certificate.start_speed, findings_.start[i].velocity);
      raise_to(certificate.start_acceleration, findings_.start[i].acceleration);
      raise_to(certificate.end_speed, findings_.end[i].velocity);
      raise_to(certificate.end_acceleration, findings_.end[i].acceleration);
    }
    for (const PlacedPeak& peak : coupling_high_) {
      findings_.coupling_high.push_back(worst(peak, 1.0));
    }
    for (const PlacedPeak& peak : coupling_low_) {
      findings_.coupling_low.push_back(worst(peak, -1.0));
    }
  }

  static Extremum extremum(const PlacedPeak& peak, double limit) {
    return {peak.peak.bound, peak.peak.bound / limit, peak.time, peak.move};
  }
  static Worst worst(const PlacedPeak& peak, double sign) {
    return {sign * peak.peak.bound, peak.time, peak.move};
  }
  static void raise_to(double& largest, const Worst& worst) {
    largest = std::max(largest, worst.value);
  }

  const JointLimits& limits_;
  std::size_t joints_;
  double time_ = 0.0;  ///< where the piece under way begins [s]
  bool started_ = false;
  std::optional<JointState> before_;  ///< where the piece before ended
  std::vector<double> sizes_;         ///< of the terms of its positions
  int last_move_ = 0;
  std::vector<JointPeaks> peaks_;
  std::vector<PlacedPeak> coupling_high_, coupling_low_;
  Findings findings_;
};

}  // namespace

Certificate certify(std::span<const TrajectoryPiece> pieces, const JointLimits& limits,
                    const std::optional<JointState>& from) {
  limits.validate();
  if (pieces.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "there is no motion to prove: no pieces");
  }
  Walk walk(limits);
  if (from) walk.go_on_from(*from);
  for (std::size_t i = 0; i < pieces.size(); ++i) walk.add(pieces[i], i);
  return std::move(walk).finish();
}

}  // namespace viapoint
