#include "viapoint/path/joint_path.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace viapoint {

PathPoint JointPiece::at(double s) const {
  const double u = s / length;
  const auto row = [this](int k) { return coefficients.row(k).transpose(); };
  // Horner, once for each derivative by u; then the chain rule with du/ds = 1 / length.
  PathPoint point;
  point.q = row(0) + u * (row(1) + u * (row(2) + u * (row(3) + u * (row(4) + u * row(5)))));
  point.q1 =
      row(1) + u * (2.0 * row(2) + u * (3.0 * row(3) + u * (4.0 * row(4) + u * 5.0 * row(5))));
  point.q2 = 2.0 * row(2) + u * (6.0 * row(3) + u * (12.0 * row(4) + u * 20.0 * row(5)));
  point.q3 = 6.0 * row(3) + u * (24.0 * row(4) + u * 60.0 * row(5));
  const double rate = 1.0 / length;
  point.q1 *= rate;
  point.q2 *= rate * rate;
  point.q3 *= rate * rate * rate;
  return point;
}

JointPiece JointPiece::hermite(const PathPoint& from, const PathPoint& to, double length) {
  assert(length > 0.0 && from.q.size() == to.q.size());
  // Derivatives by u, and the three conditions at u = 1 solved for the three upper coefficients.
  const JointVector a1 = from.q1 * length;
  const JointVector a2 = from.q2 * (0.5 * length * length);
  const JointVector gap = to.q - from.q - a1 - a2;
  const JointVector slope = to.q1 * length - a1 - 2.0 * a2;
  const JointVector bend = to.q2 * (length * length) - 2.0 * a2;
  JointPiece piece;
  piece.length = length;
  piece.kind = PieceKind::kCurve;
  piece.coefficients.resize(6, from.q.size());
  piece.coefficients.row(0) = from.q.transpose();
  piece.coefficients.row(1) = a1.transpose();
  piece.coefficients.row(2) = a2.transpose();
  piece.coefficients.row(3) = (10.0 * gap - 4.0 * slope + 0.5 * bend).transpose();
  piece.coefficients.row(4) = (-15.0 * gap + 7.0 * slope - bend).transpose();
  piece.coefficients.row(5) = (6.0 * gap - 3.0 * slope + 0.5 * bend).transpose();
  return piece;
}

JointPiece JointPiece::line(const JointVector& a, const JointVector& b, double length) {
  assert(length > 0.0 && a.size() == b.size());
  JointPiece piece;
  piece.length = length;
  piece.kind = PieceKind::kJointLine;
  piece.coefficients.setZero(6, a.size());
  piece.coefficients.row(0) = a.transpose();
  piece.coefficients.row(1) = (b - a).transpose();
  return piece;
}

JointPiece JointPiece::part(double s0, double s1) const {
  assert(s1 > s0);
  JointPiece piece = *this;
  piece.length = s1 - s0;
  // Taylor shift to u0 by repeated synthetic division, then the new scale.
  const double u0 = s0 / length;
  for (int first = 0; first < 5; ++first) {
    for (int k = 4; k >= first; --k) {
      piece.coefficients.row(k) += u0 * piece.coefficients.row(k + 1);
    }
  }
  const double ratio = piece.length / length;
  double power = ratio;
  for (int k = 1; k < 6; ++k, power *= ratio) {
    piece.coefficients.row(k) *= power;
  }
  return piece;
}

void JointPath::append(JointPiece piece) {
  assert(piece.length > 0.0);
  starts_.push_back(end_);
  end_ += piece.length;
  pieces_.push_back(std::move(piece));
}

size_t JointPath::piece_at(double s) const {
  assert(!starts_.empty());
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), s);
  return after == starts_.begin() ? 0 : static_cast<size_t>(after - starts_.begin()) - 1;
}

PathPoint JointPath::at(double s) const {
  const size_t i = piece_at(s);
  return pieces_[i].at(std::clamp(s - starts_[i], 0.0, pieces_[i].length));
}

}  // namespace viapoint
