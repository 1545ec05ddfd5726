#include "viapoint/path/tool_rates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/bernstein_bounds.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr int kNodes = 6;
/// Of the node polynomial N(u) = 2/4⁶ T₆(2u − 1) over 6!: sup|N| and sup|N'|.
constexpr double kErrorShare = 2.0 / 4096.0 / 720.0, kSlopeErrorShare = 72.0 * kErrorShare;
/// What solving for the coefficients may lose, as a share of w.
constexpr double kRounding = 1e-11;
/// Derivatives of p up to the seventh.
constexpr size_t kOrders = 8;
using Orders = std::array<double, kOrders>;

constexpr auto kBinomials = [] {
  std::array<std::array<double, kOrders>, kOrders> table{};
  for (size_t n = 0; n < kOrders; ++n) {
    table[n][0] = 1.0;
    for (size_t k = 1; k <= n; ++k) table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
  }
  return table;
}();

double node(int k) { return 0.5 - 0.5 * std::cos((2 * k + 1) * kPi / (2 * kNodes)); }

/// From the values at the nodes to coefficients.
const Eigen::Matrix<double, kNodes, kNodes>& interpolation() {
  static const Eigen::Matrix<double, kNodes, kNodes> matrix = [] {
    Eigen::Matrix<double, kNodes, kNodes> powers;
    for (int k = 0; k < kNodes; ++k) {
      for (int m = 0; m < kNodes; ++m) powers(k, m) = std::pow(node(k), m);
    }
    return Eigen::Matrix<double, kNodes, kNodes>(powers.inverse());
  }();
  return matrix;
}

/// sup |d^k q / du^k| of one joint, k = 1…5.
template <size_t Order>
double sup_derivative(const JointPiece& piece, int joint) {
  std::array<double, 6 - Order> c{};
  for (size_t k = 0; k < c.size(); ++k) {
    double factor = 1.0;
    for (size_t m = 0; m < Order; ++m) factor *= static_cast<double>(k + Order - m);
    c[k] = factor * piece.coefficients(static_cast<Eigen::Index>(k + Order), joint);
  }
  double most = 0.0;
  for (const double b : to_bernstein(c)) most = std::max(most, std::abs(b));
  return most;
}

Orders sup_derivatives(const JointPiece& piece, int joint) {
  return {0.0,
          sup_derivative<1>(piece, joint),
          sup_derivative<2>(piece, joint),
          sup_derivative<3>(piece, joint),
          sup_derivative<4>(piece, joint),
          sup_derivative<5>(piece, joint),
          0.0,
          0.0};
}

/// Complete Bell polynomials of x[1], x[2], …
Orders bell(const Orders& x) {
  Orders b{};
  b[0] = 1.0;
  for (size_t n = 0; n + 1 < kOrders; ++n) {
    for (size_t k = 0; k <= n; ++k) b[n + 1] += kBinomials[n][k] * b[n - k] * x[k + 1];
  }
  return b;
}

/// Bounds of ‖w⁽⁶⁾‖ for both.
struct Sixth {
  double linear = 0.0, angular = 0.0;
};

/// A derivative of p by several joints is at most as long as the tool can be far from the axis of
/// the outermost of them (1 where that one slides). So the terms of the chain rule whose outermost
/// joint is i are those of the Bell polynomial of the joints up to i less that of those before.
Sixth sixth_derivatives(const ForwardKinematics& arm, const JointPiece& piece) {
  JointVector travel(piece.joints());
  for (Eigen::Index i = 0; i < travel.size(); ++i) {
    travel[i] = piece.coefficients.col(i).cwiseAbs().sum();
  }
  const JointVector reach = arm.reach_bound(travel);
  Sixth sixth;
  Orders sum{};
  Orders before = bell(sum);
  for (int i = 0; i < piece.joints(); ++i) {
    const bool turns = arm.type(i) == JointType::kRevolute;
    const Orders x = sup_derivatives(piece, i);
    if (turns) {  // ω has the term q_i' z_i, and z_i turns with the joints before
      for (size_t k = 0; k <= 6; ++k) sixth.angular += kBinomials[6][k] * x[7 - k] * before[k];
    }
    for (size_t k = 1; k < kOrders; ++k) sum[k] += x[k];
    const Orders here = bell(sum);
    sixth.linear += (turns ? reach[i] : 1.0) * (here[7] - before[7]);
    before = here;
  }
  return sixth;
}

ToolRate through(const Eigen::Matrix<double, kNodes, 3>& values, double sixth) {
  const Eigen::Matrix<double, kNodes, 3> c = interpolation() * values;
  ToolRate rate;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < kNodes; ++k) {
      rate.coefficients[static_cast<size_t>(axis)][static_cast<size_t>(k)] = c(k, axis);
    }
  }
  const double rounding = kRounding * values.cwiseAbs().maxCoeff();
  rate.error = kErrorShare * sixth + rounding;
  rate.slope_error = kSlopeErrorShare * sixth + 72.0 * rounding;
  return rate;
}

double largest(const ToolRate& rate) {
  double most = 0.0;
  for (int k = 0; k < kNodes; ++k) {
    double square = 0.0;
    for (const auto& c : rate.coefficients) {
      const double u = node(k);
      const double w = c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
      square += w * w;
    }
    most = std::max(most, square);
  }
  return std::sqrt(most);
}

/// A rate below this [m or rad by the path's own unit] is rounding: the tool's point or its
/// orientation stays, and no halving makes that more precise.
constexpr double kStill = 1e-9;

bool precise(const ToolRate& rate, double share) {
  const double size = largest(rate);
  if (size <= kStill) return true;
  return rate.error <= share * size && rate.slope_error <= 10.0 * share * size;
}

void append(const ForwardKinematics& arm, const JointPiece& piece, int halvings,
            PathWithTool& result) {
  constexpr double kHeld = 1e-7, kLimited = 1e-3;
  const ToolLimits& limits = piece.tool;
  ToolRates rates;
  if (limits.any()) {
    rates = tool_rates(arm, piece);
    const double share = limits.hold_speed ? kHeld : kLimited;
    const bool moves = limits.speed < ToolLimits::kNone || limits.acceleration < ToolLimits::kNone;
    if (halvings > 0 && ((moves && !precise(rates.linear, share)) ||
                         (limits.turns() && !precise(rates.angular, kLimited)))) {
      const double middle = 0.5 * piece.length;
      append(arm, piece.part(0.0, middle), halvings - 1, result);
      append(arm, piece.part(middle, piece.length), halvings - 1, result);
      return;
    }
    // A tool that turns on the spot has no speed to hold.
    if (largest(rates.linear) <= kStill) rates.limits.hold_speed = false;
  }
  result.path.append(piece);
  result.rates.push_back(rates);
}

}  // namespace

ToolRates tool_rates(const ForwardKinematics& arm, const JointPiece& piece) {
  ToolRates rates;
  rates.limits = piece.tool;
  Eigen::Matrix<double, kNodes, 3> linear, angular;
  for (int k = 0; k < kNodes; ++k) {
    const PathPoint point = piece.at(node(k) * piece.length);
    const Twist twist = arm.jacobian(arm.frames(point.q)) * (piece.length * point.q1);
    linear.row(k) = twist.head<3>().transpose();
    angular.row(k) = twist.tail<3>().transpose();
  }
  const Sixth sixth = sixth_derivatives(arm, piece);
  rates.linear = through(linear, sixth.linear);
  rates.angular = through(angular, sixth.angular);
  return rates;
}

PathWithTool with_tool_rates(const ForwardKinematics& arm, const JointPath& path) {
  constexpr int kMostHalvings = 4;
  const auto& pieces = path.pieces();
  if (std::none_of(pieces.begin(), pieces.end(),
                   [](const JointPiece& piece) { return piece.tool.any(); })) {
    return {path, {}};
  }
  PathWithTool result;
  for (const JointPiece& piece : pieces) append(arm, piece, kMostHalvings, result);
  return result;
}

}  // namespace viapoint
