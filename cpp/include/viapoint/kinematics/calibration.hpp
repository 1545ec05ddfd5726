/// @file
/// Tools and frames found by touching points with the arm: where the tool's point is on the flange,
/// how the tool stands there, and where a workpiece stands. All by least squares, all saying how
/// well the points agree, and all refusing points that cannot tell what is asked for.
/// Real-time: not. Threads: any.
#pragma once

#include <span>
#include <vector>

#include "viapoint/core/pose.hpp"

namespace viapoint {

/// A set of touched points is refused when an error of touching may grow by more than this on its
/// way to what is looked for.
inline constexpr double kMostSensitivity = 5.0;
/// Points that tell a direction are at least so far apart [m], and the two directions that tell a
/// frame at least so far from one line [rad] (5°).
inline constexpr double kLeastTravel = 1e-3;
inline constexpr double kLeastAngle = 0.0872664625997165;

/// How well touched points agree with what was found from them.
struct Fit {
  std::vector<double> residuals;  ///< of each touched point [m]
  double rms = 0.0;               ///< of the residuals [m]
  double largest = 0.0;           ///< [m]
  int worst = 0;                  ///< index of the touched point that has it
};

/// The tool's point from touching one fixed point with several orientations.
struct TcpCalibration {
  Eigen::Vector3d tcp;    ///< tool's point, in the flange frame [m]
  Eigen::Vector3d point;  ///< the fixed point, in the base frame [m]
  Fit fit;
  /// Standard deviation of the TCP along the direction that is known least, over that of a touch
  /// along each axis.
  double sensitivity = 0.0;
  /// The same times what the residuals say of a touch: what to expect of the TCP [m].
  double uncertainty = 0.0;
};

/// From n ≥ 4 poses of the flange that hold the tool's point t on one fixed point c:
/// R_i t + p_i = c, of which the mean over all poses is taken away; the rest is linear in t.
/// @param pose_base_flange poses of the flange, (n,)
/// @throws MotionError(kBadArgument) for fewer than four; kDegeneratePoints where the orientations
/// are too much alike, or all turn about one axis, along which the tool then is not known
[[nodiscard]] TcpCalibration calibrate_tcp(std::span<const Pose> pose_base_flange);

/// Point and orientation of a tool.
struct ToolCalibration {
  Pose pose_flange_tool;
  TcpCalibration tcp;
  /// Angle of the two ways over which the axes were shown [rad]: π/2 but for errors.
  double angle = 0.0;
};

/// The six-point method: calibrate_tcp(), and from the last of its poses the tool is moved along
/// its own +x to `along_x`, and from that last pose again along its own +z to `along_z`. z is taken
/// as it was shown, x is made square to it.
/// @throws MotionError as calibrate_tcp(); kDegeneratePoints too where a way is shorter than
/// kLeastTravel or the two are less than kLeastAngle from one line
[[nodiscard]] ToolCalibration calibrate_tool(std::span<const Pose> pose_base_flange,
                                             const Pose& along_x, const Pose& along_z);

/// The frame with its origin at `origin`, +x through `on_x`, and `on_xy` in the half-plane of +y.
/// @param origin, on_x, on_xy in the base frame [m]
/// @throws MotionError(kDegeneratePoints) where two are nearer than kLeastTravel, or the three less
/// than kLeastAngle from one line; kBadArgument
[[nodiscard]] Pose frame_from_points(const Eigen::Vector3d& origin, const Eigen::Vector3d& on_x,
                                     const Eigen::Vector3d& on_xy);

/// A frame whose points are known beforehand.
struct FrameFit {
  Pose pose_base_frame;
  Fit fit;
};

/// The frame in which touched points have known coordinates, by least squares (Arun, Huang &
/// Blostein 1987, with the sign of Umeyama 1991). With the roles exchanged it places the arm: its
/// base in the frame that the coordinates are told in.
/// @param known coordinates in the frame [m]; @param touched in the base frame [m]; n ≥ 3 each
/// @throws MotionError(kBadArgument); kDegeneratePoints where the known points lie on one line
[[nodiscard]] FrameFit frame_from_known_points(std::span<const Eigen::Vector3d> known,
                                               std::span<const Eigen::Vector3d> touched);

}  // namespace viapoint
