/// @file
/// Geometry in joint space. A path is q(s): quintic pieces that meet with equal q, q' and q''
/// (C²), except where the arm stops. No time is in it: speed is decided later and never changes it.
#pragma once

#include <limits>
#include <vector>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// Coefficients of n quintics: row k holds those of u^k, (6, n).
using QuinticCoefficients =
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;

/// q and its derivatives by the path parameter s, each (n,).
struct PathPoint {
  JointVector q, q1, q2, q3;
};

enum class PieceKind {
  kJointLine,  ///< straight in joint space
  kCurve,      ///< follows a task-space curve within a proven deviation
  kBlend,      ///< a corner
};

/// What the tool may do along a piece, over the joints' limits; infinite: all that these allow.
struct ToolLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double speed = kNone;                 ///< of the tool point [m/s]
  double acceleration = kNone;          ///< of the tool point [m/s²]
  double angular_speed = kNone;         ///< of the tool [rad/s]
  double angular_acceleration = kNone;  ///< of the tool [rad/s²]
  /// `speed` is to be kept wherever the limits allow, not only not to be exceeded.
  bool hold_speed = false;
  /// Share of the joints' limits that may be used meanwhile: no limit of the tool, but what a speed
  /// that is not held is judged by.
  double joint_share = 1.0;

  [[nodiscard]] bool any() const { return speed < kNone || acceleration < kNone || turns(); }
  [[nodiscard]] bool turns() const { return angular_speed < kNone || angular_acceleration < kNone; }
  bool operator==(const ToolLimits&) const = default;
};

/// One quintic piece: q(s) = Σ_k coefficients.row(k) u^k with u = s / length in [0, 1].
struct JointPiece {
  QuinticCoefficients coefficients;
  double length = 0.0;  ///< of the parameter s, > 0 (any unit; consistent along one section)
  PieceKind kind = PieceKind::kJointLine;
  int move = 0;  ///< the program step that this piece serves (a blend: the step it leaves)
  /// Share of all joint limits this piece may use, in (0, 1] (velocity; acceleration and jerk keep
  /// their limits times the same share).
  double scale = 1.0;
  ToolLimits tool;
  double position_deviation = 0.0;  ///< proven distance of the tool from the wanted curve [m]
  double angle_deviation = 0.0;     ///< proven [rad]

  [[nodiscard]] int joints() const { return static_cast<int>(coefficients.cols()); }
  /// Value and derivatives at s in [0, length]. Real-time: safe.
  [[nodiscard]] PathPoint at(double s) const;

  /// The quintic with the given q, q', q'' (by s) at both ends (Hermite).
  [[nodiscard]] static JointPiece hermite(const PathPoint& from, const PathPoint& to,
                                          double length);
  /// Straight from a to b with constant q'; length is that of s. @pre length > 0
  [[nodiscard]] static JointPiece line(const JointVector& a, const JointVector& b, double length);
  /// The part between s0 and s1 as a piece of its own, the same curve to rounding.
  [[nodiscard]] JointPiece part(double s0, double s1) const;
};

/// Pieces one after the other. One section of a motion: the arm rests at its ends only.
class JointPath {
 public:
  void append(JointPiece piece);
  [[nodiscard]] const std::vector<JointPiece>& pieces() const { return pieces_; }
  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] double length() const { return starts_.empty() ? 0.0 : end_; }
  /// s where piece i begins.
  [[nodiscard]] double start_of(size_t piece) const { return starts_[piece]; }
  /// Index of the piece that holds s (the later one at a knot).
  [[nodiscard]] size_t piece_at(double s) const;
  [[nodiscard]] PathPoint at(double s) const;

 private:
  std::vector<JointPiece> pieces_;
  std::vector<double> starts_;
  double end_ = 0.0;
};

}  // namespace viapoint
