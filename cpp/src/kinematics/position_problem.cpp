#include "kinematics/position_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinematics/closed_form.hpp"

namespace viapoint {
namespace {

/// A coefficient below this share of the arm's size does not count.
constexpr double kNothing = 1e-10;

bool commute(const Screw& a, const Screw& b) {
  return a.type != b.type && a.axis.cross(b.axis).norm() < kExactAxes;
}

/// Points of axis b worth measuring distances from: where neighbours meet it, else its origin.
std::vector<Eigen::Vector3d> centres_on(const Screw& middle, std::span<const Screw> neighbours) {
  std::vector<Eigen::Vector3d> out;
  for (const Screw& other : neighbours) {
    if (other.type != JointType::kRevolute) continue;
    const auto meeting = nearest_point(middle.origin, middle.axis, other.origin, other.axis);
    if (meeting && other.axis.cross(*meeting - other.origin).norm() < kExactAxes) {
      out.push_back(*meeting);
    }
  }
  out.push_back(middle.origin);
  return out;
}

/// Two directions across a slide, the first blind to a neighbour where one can be.
std::array<Eigen::Vector3d, 2> directions_across(const Screw& slide,
                                                 std::span<const Screw> neighbours) {
  Eigen::Vector3d first = slide.axis.unitOrthogonal();
  for (const Screw& other : neighbours) {
    // Along its axis a turning joint moves nothing; a slide moves nothing square to its own.
    const Eigen::Vector3d blind =
        other.type == JointType::kRevolute ? other.axis : slide.axis.cross(other.axis).eval();
    const bool square = std::abs(blind.dot(slide.axis)) < kExactAxes;
    if (!square || blind.norm() < 1e-6) continue;
    first = blind.normalized();
    break;
  }
  return {first, slide.axis.cross(first)};
}

}  // namespace

std::optional<PositionProblem> PositionProblem::plan(std::span<const Screw> joints,
                                                     const Eigen::Vector3d& point) {
  // Slots for first, middle, last; a slide along a turning neighbour's axis may change places with
  // it, so that a turning joint comes to stand in the middle.
  std::vector<std::array<int, 3>> orders;
  if (joints.size() == 1) orders = {{kNone, 0, kNone}};
  if (joints.size() == 2) orders = {{kNone, 0, 1}};
  if (joints.size() == 3) {
    const bool slide_last = commute(joints[0], joints[2]) && commute(joints[1], joints[2]);
    if (slide_last) orders.push_back({2, 0, 1});
    orders.push_back({0, 1, 2});
    if (commute(joints[0], joints[1])) orders.push_back({1, 0, 2});
    if (commute(joints[1], joints[2])) orders.push_back({0, 2, 1});
  }
  for (const auto& order : orders) {
    PositionProblem problem;
    problem.index_ = order;
    problem.point_ = point;
    std::vector<Screw> neighbours;
    for (size_t slot = 0; slot < 3; ++slot) {
      if (order[slot] == kNone) continue;
      problem.joint_[slot] = joints[static_cast<size_t>(order[slot])];
      if (slot != 1) neighbours.push_back(problem.joint_[slot]);
    }
    const Screw& middle = problem.joint_[1];
    problem.size_ = std::max((point - middle.origin).norm(), 1e-3);
    for (const Screw& other : neighbours) {
      problem.size_ = std::max(problem.size_, (other.origin - middle.origin).norm());
    }
    if (middle.type == JointType::kPrismatic) {
      problem.across_ = directions_across(middle, neighbours);
      if (problem.decouple(joints)) return problem;
      continue;
    }
    for (const Eigen::Vector3d& centre : centres_on(middle, neighbours)) {
      problem.centre_ = centre;
      if (problem.decouple(joints)) return problem;
    }
  }
  return std::nullopt;
}

PositionProblem::Equations PositionProblem::equations(const Eigen::Vector3d& target) const {
  Equations out;
  out.back = index_[0] == kNone ? Track::still(target) : Track::back(joint_[0], target);
  out.ahead = index_[2] == kNone ? Track::still(point_) : Track::of(joint_[2], point_);
  const bool slides = joint_[1].type == JointType::kPrismatic;
  const Eigen::Vector3d& direction = slides ? across_[0] : joint_[1].axis;
  out.of_first[0] = JointTerm::height(out.back, direction);
  out.of_last[0] = JointTerm::height(out.ahead, direction);
  out.of_first[1] =
      slides ? JointTerm::height(out.back, across_[1]) : JointTerm::square(out.back, centre_);
  out.of_last[1] =
      slides ? JointTerm::height(out.ahead, across_[1]) : JointTerm::square(out.ahead, centre_);
  return out;
}

bool PositionProblem::decouple(std::span<const Screw> joints) {
  // Which rows have which joint, at targets in general position.
  std::array<bool, 2> has_first{};
  std::array<bool, 2> has_last{};
  for (int sample = 1; sample <= 4; ++sample) {
    Eigen::Vector3d target = point_;
    for (size_t i = joints.size(); i-- > 0;) {
      target = joints[i].motion(std::sin(2.1 * sample + 1.3 * static_cast<double>(i))) * target;
    }
    const Equations rows = equations(target);
    for (size_t row = 0; row < 2; ++row) {
      has_first[row] = has_first[row] || rows.of_first[row].weight() > kNothing * size_;
      has_last[row] = has_last[row] || rows.of_last[row].weight() > kNothing * size_;
    }
  }
  choices_ = {};
  const auto choose = [&](size_t slot, int row) {
    const Screw& joint = joint_[slot];
    const bool squares = row == 1 && joint_[1].type == JointType::kRevolute;
    if (joint.type == JointType::kRevolute || squares) {
      choices_[static_cast<size_t>(index_[slot])] = true;
    }
  };
  if (index_[2] == kNone) return true;  // one joint
  if (index_[0] == kNone) {             // two joints
    for (const int row : {0, 1}) {
      if (!has_last[static_cast<size_t>(row)]) continue;
      row_ = row;
      last_first_ = true;
      choose(2, row);
      return true;
    }
    return false;
  }
  for (const int row : {0, 1}) {
    const auto here = static_cast<size_t>(row);
    const size_t other = 1 - here;
    const bool last_only = has_last[here] && !has_first[here] && has_first[other];
    const bool first_only = has_first[here] && !has_last[here] && has_last[other];
    if (!last_only && !first_only) continue;
    row_ = row;
    last_first_ = last_only;
    choose(last_only ? 2 : 0, row);
    choose(last_only ? 0 : 2, 1 - row);
    return true;
  }
  return false;
}

namespace {

/// Of a distance from a point on an axis, the part across the axis.
double across(double distance, double height) {
  return std::sqrt(std::max(0.0, (distance - height) * (distance + height)));
}

}  // namespace

double PositionProblem::common_height(const Equations& rows) const {
  if (joint_[1].type == JointType::kPrismatic) return 0.0;
  const bool by_last = rows.of_last[0].weight() < rows.of_first[0].weight();
  const JointTerm& side = by_last ? rows.of_last[0] : rows.of_first[0];
  if (side.weight() > kNothing * size_) return 0.0;
  const double height = side.constant;
  return std::abs(height - joint_[1].axis.dot(centre_));
}

Roots PositionProblem::solve_row(int row, const JointTerm& term, double value, double height,
                                 double& missing) const {
  const bool squares = row == 1 && joint_[1].type == JointType::kRevolute;
  const double unit = squares ? size_ : 1.0;
  const double distance = squares ? std::sqrt(std::max(0.0, value)) : 0.0;
  const double slack = squares ? kBoundary * (2.0 * distance + kBoundary) : kBoundary;
  Roots roots = term.solve(value, slack, kNothing * size_ * unit);
  if (roots.count > 0) return roots;
  double out = roots.missing;
  if (squares) {  // from a difference of squares to one of distances
    const bool far = value > term.constant;
    const double reached = std::sqrt(std::max(0.0, value + (far ? -out : out)));
    out = std::abs(across(distance, height) - across(reached, height));
  }
  missing = missing == 0.0 ? out : std::min(missing, out);
  return roots;
}

void PositionProblem::solve(const Eigen::Vector3d& target, std::span<const double> held,
                            PositionRoots& found) const {
  const Equations rows = equations(target);
  double missing = 0.0;
  const auto finish = [&](PositionRoot root, double q1, double q3) {
    const Eigen::Vector3d x = rows.ahead.at(q3);
    const Eigen::Vector3d y = rows.back.at(q1);
    const Screw& middle = joint_[1];
    double q2 = 0.0;
    if (middle.type == JointType::kPrismatic) {
      q2 = middle.axis.dot(y - x);
    } else if (middle.axis.cross(x - middle.origin).norm() < kOnAxis) {
      q2 = held[static_cast<size_t>(index_[1])];
      found.held = true;
    } else {
      q2 = angle_about(middle.axis, x - middle.origin, y - middle.origin);
    }
    const std::array values{q1, q2, q3};
    for (size_t slot = 0; slot < 3; ++slot) {
      if (index_[slot] != kNone) root.q[static_cast<size_t>(index_[slot])] = values[slot];
    }
    if (static_cast<size_t>(found.count) < found.roots.size()) {
      found.roots[static_cast<size_t>(found.count++)] = root;
    }
  };
  const auto note = [&](PositionRoot& root, size_t slot, const Roots& roots, int which) {
    const auto joint = static_cast<size_t>(index_[slot]);
    root.side[joint] = which == 0 ? roots.apart : -roots.apart;
  };
  const auto value_of = [&](size_t slot, const Roots& roots, int which) {
    found.held = found.held || roots.free;
    return roots.free ? held[static_cast<size_t>(index_[slot])]
                      : roots.q[static_cast<size_t>(which)];
  };

  if (index_[2] == kNone) {
    finish({}, 0.0, 0.0);
    return;
  }
  const size_t slot_a = last_first_ ? 2 : 0;
  const auto row_a = static_cast<size_t>(row_);
  const JointTerm& term_a = last_first_ ? rows.of_last[row_a] : rows.of_first[row_a];
  const JointTerm& rest_a = last_first_ ? rows.of_first[row_a] : rows.of_last[row_a];
  const double height = common_height(rows);
  const Roots roots_a = solve_row(row_, term_a, rest_a.constant, height, missing);
  for (int a = 0; a < roots_a.count; ++a) {
    PositionRoot root;
    const double qa = value_of(slot_a, roots_a, a);
    note(root, slot_a, roots_a, a);
    if (index_[0] == kNone) {
      finish(root, 0.0, qa);
      continue;
    }
    const size_t slot_b = 2 - slot_a;
    const size_t row_b = 1 - row_a;
    const JointTerm& term_b = last_first_ ? rows.of_first[row_b] : rows.of_last[row_b];
    const JointTerm& rest_b = last_first_ ? rows.of_last[row_b] : rows.of_first[row_b];
    const Roots roots_b = solve_row(1 - row_, term_b, rest_b.at(qa), height, missing);
    for (int b = 0; b < roots_b.count; ++b) {
      PositionRoot both = root;
      const double qb = value_of(slot_b, roots_b, b);
      note(both, slot_b, roots_b, b);
      finish(both, last_first_ ? qb : qa, last_first_ ? qa : qb);
    }
  }
  found.near_miss = missing;
  if (found.count == 0) found.missing = missing;
}

}  // namespace viapoint
