/// @file
/// How the tool moves along a joint piece q(u), u in [0, 1]: the velocity of its point dp/du and
/// its angular velocity ω, both by u, as quintics with a proven error. With them
///     ṗ = p_u u̇,   p̈ = p_uu u̇² + p_u ü,   and the same of ω,
/// can be limited and bounded without any kinematics.
#pragma once

#include <array>
#include <vector>

#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// A vector w(u): on axis i, Σ_k coefficients[i][k] u^k.
struct ToolRate {
  std::array<std::array<double, 6>, 3> coefficients{};
  double error = 0.0;        ///< ‖w − Σ‖ is at most this on [0, 1]
  double slope_error = 0.0;  ///< the same of the derivatives by u
};

struct ToolRates {
  ToolLimits limits;
  ToolRate linear;   ///< dp/du in the base frame [m]
  ToolRate angular;  ///< ω per u̇ in the base frame [rad]
};

/// The quintics through w at the six Chebyshev nodes. With sup|q^(k)| of every joint, the farthest
/// the tool can be from its axis and the chain rule (complete Bell polynomials) the sixth
/// derivative of w is bounded, and the error and that of its derivative by
/// ‖N‖ / 6! · sup‖w⁽⁶⁾‖ and ‖N'‖ / 6! · sup‖w⁽⁶⁾‖ with N the nodes' polynomial (Cauchy; Shadrin
/// 1995). Real-time: not. Threads: any.
[[nodiscard]] ToolRates tool_rates(const ForwardKinematics& arm, const JointPiece& piece);

/// A path whose pieces are short enough for their tool rates.
struct PathWithTool {
  JointPath path;
  std::vector<ToolRates> rates;  ///< one a piece; empty where no piece limits the tool
};

/// The same path, with those pieces in halves, and halves of these, whose tool rates would be off
/// by more than a share of themselves: 1e-7 where the speed is to be held, 1e-3 elsewhere. The
/// error counts against the limits all the same.
[[nodiscard]] PathWithTool with_tool_rates(const ForwardKinematics& arm, const JointPath& path);

}  // namespace viapoint
