#include "planning/path_timer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "planning/tool_proof.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace viapoint::planning {
namespace {

/// Pieces of path before the end of the timing under way that are timed anew with what follows it:
/// room to speed up from rest, to slow down to it, and for the way over in between.
constexpr std::size_t kOverlap = 18;
/// Pieces of path that a window of a known path goes on by, and up to which a section is one.
constexpr std::size_t kWindow = 96, kOneWindow = 144;
/// What counts as kept: rounding over one.
constexpr double kKept = 1.0 + 1e-9;
/// Of pieces that nothing can be compared with.
constexpr std::size_t kNoNumber = std::numeric_limits<std::size_t>::max();

/// Timing cuts a piece of path into sixteenths at most where the tool is limited.
constexpr std::size_t kParts = 16;

/// Numbers of timing count sixteenths of pieces of path.
std::size_t number_of(std::size_t piece, double share) {
  return piece * kParts + static_cast<std::size_t>(std::lround(share * kParts));
}
std::size_t piece_of(std::size_t number) { return number / kParts; }

bool has_start(const TrajectoryPiece& timed, const JointPiece& piece) {
  for (int i = 0; i < timed.joints; ++i) {
    if (timed.path[0][static_cast<size_t>(i)] != piece.coefficients(0, i)) return false;
  }
  return true;
}

/// From rest to rest along a path whose first piece is the `first`.
NumberedTiming time_at_rest(const RobotModel& robot, const JointPath& path, std::size_t first) {
  const auto& whole = path.pieces();
  const bool limits_tool =
      std::any_of(whole.begin(), whole.end(), [](const auto& piece) { return piece.tool.any(); });
  NumberedTiming timing;
  if (!limits_tool) {
    TimedPath timed = parameterize(path, robot.limits(), {});
    timing.pieces = std::move(timed.pieces);
    for (const std::size_t origin : timed.origin) {
      timing.number.push_back(number_of(first + origin, 0.0));
    }
    return timing;
  }
  const PathWithTool parts = with_tool_rates(robot.forward(), path);
  std::vector<std::size_t> numbers;
  std::size_t at = 0;
  double done = 0.0;
  for (const JointPiece& part : parts.path.pieces()) {
    if (done > (1.0 - 0.5 / kParts) * whole[at].length) {
      ++at;
      done = 0.0;
    }
    numbers.push_back(number_of(first + at, done / whole[at].length));
    done += part.length;
  }
  TimedPath timed = parameterize(parts.path, robot.limits(), parts.rates);
  timing.pieces = std::move(timed.pieces);
  for (const std::size_t origin : timed.origin) timing.number.push_back(numbers[origin]);
  return timing;
}

}  // namespace

void PathTimer::append(const JointPath& path) {
  for (const JointPiece& piece : path.pieces()) path_.push_back(piece);
}

NumberedTiming PathTimer::time(std::size_t from, const JointPath& certain) const {
  JointPath path;
  for (std::size_t k = from - first_; k < path_.size(); ++k) path.append(path_[k]);
  for (const JointPiece& piece : certain.pieces()) path.append(piece);
  return time_at_rest(robot_, path, from);
}

const JointPiece& PathTimer::piece(std::size_t number) const {
  const std::size_t index = piece_of(number) - first_;
  return index < path_.size() ? path_[index] : certain_.pieces()[piece_of(number) - certain_first_];
}

std::vector<ToolLimits> PathTimer::tool() const {
  std::vector<ToolLimits> limits;
  for (const std::size_t number : timing_.number) {
    limits.push_back(piece(number).tool);
    limits.back().joint_share = piece(number).scale;
  }
  const bool any = std::any_of(limits.begin(), limits.end(), [](const auto& l) { return l.any(); });
  return any ? limits : std::vector<ToolLimits>();
}

double PathTimer::extend(const JointPath& certain, double not_before) {
  const std::size_t end = first_ + path_.size();
  double leave = 0.0;
  if (timing_.pieces.empty()) {
    timing_ = time(first_, certain);
  } else {
    adopt_certain();
    rest_piece_ = certain_first_;
    rest_passed_ = certain_.length();
    const auto try_from = [&](std::size_t from) {
      const NumberedTiming later = time(from, certain);
      return join_timings(timing_, later, not_before,
                          [&](std::span<const TrajectoryPiece> pieces, std::size_t number) {
                            return holds(pieces, number);
                          });
    };
    const std::size_t from = window_start(kOverlap), earliest = window_start(kNoNumber);
    auto join = try_from(from);
    if (!join && earliest < from) join = try_from(earliest);
    if (join) {
      leave = join->leave;
      timing_ = std::move(join->timing);
    } else {
      leave = duration_of(timing_.pieces);
      begin_after_rest(rest_piece_, rest_passed_);
      timing_ = time(first_, certain);
      ++stops_;
    }
  }
  for (; first_ < piece_of(timing_.number.front()) && !path_.empty(); ++first_) {
    if (first_ >= rest_piece_) {
      rest_passed_ -= path_.front().length;
      rest_piece_ = first_ + 1;
    }
    path_.pop_front();
  }
  certain_ = certain;
  certain_first_ = end;
  return leave;
}

std::size_t PathTimer::window_start(std::size_t overlap) const {
  // The first piece of path of a timing that begins at speed is not there as a whole.
  const bool whole =
      timing_.pieces.front().timing[0] <= 0.0 && timing_.number.front() % kParts == 0;
  const std::size_t earliest = piece_of(timing_.number.front()) + (whole ? 0 : 1);
  const std::size_t end = certain_first_ + certain_.pieces().size();
  return std::max(earliest, end > overlap ? end - overlap : 0);
}

bool PathTimer::holds(std::span<const TrajectoryPiece> pieces, std::size_t number) const {
  const double scale = piece(number).scale;
  const Certificate certificate = certify(pieces, robot_.limits());
  for (const auto* extrema :
       {&certificate.velocity, &certificate.acceleration, &certificate.jerk}) {
    for (const Extremum& extremum : *extrema) {
      if (!(extremum.share <= kKept * scale)) return false;
    }
  }
  const ToolLimits& limits = piece(number).tool;
  if (!limits.any()) return true;
  ToolProof proof;
  proof.add(robot_, pieces, std::vector<ToolLimits>(pieces.size(), limits), 0.0);
  const ToolExtrema& tool = proof.extrema();
  return std::max({tool.speed.share, tool.acceleration.share, tool.angular_speed.share,
                   tool.angular_acceleration.share}) <= kKept;
}

/// What was certain is part of what was appended since: the timing along it by those pieces.
void PathTimer::adopt_certain() {
  for (std::size_t k = 0; k < timing_.pieces.size(); ++k) {
    const std::size_t number = timing_.number[k];
    if (number == kNoNumber || piece_of(number) < certain_first_) continue;
    TrajectoryPiece& timed = timing_.pieces[k];
    const JointPiece& part = certain_.pieces()[piece_of(number) - certain_first_];
    const bool there = piece_of(number) < first_ + path_.size() && !part.tool.any() &&
                       has_start(timed, piece(number));
    if (!there) {
      timing_.number[k] = kNoNumber;
      continue;
    }
    const JointPiece& whole = piece(number);
    for (double& coefficient : timed.timing) coefficient *= part.length / whole.length;
    for (int row = 0; row < 6; ++row) {
      for (int i = 0; i < timed.joints; ++i) {
        timed.path[static_cast<size_t>(row)][static_cast<size_t>(i)] = whole.coefficients(row, i);
      }
    }
  }
}

void PathTimer::begin_after_missing() {
  begin_after_rest(rest_piece_, rest_passed_);
  timing_ = time(first_, certain_);
  ++stops_;
}

/// The arm rests where it has `passed` so much since the start of a piece: the path begins there.
void PathTimer::begin_after_rest(std::size_t piece, double passed) {
  for (; first_ < piece; ++first_) path_.pop_front();
  while (!path_.empty() && passed >= path_.front().length * (1.0 - 1e-12)) {
    passed -= path_.front().length;
    path_.pop_front();
    ++first_;
  }
  if (passed > 0.0 && !path_.empty()) {
    path_.front() = path_.front().part(passed, path_.front().length);
  }
}

double duration_at_rest(const RobotModel& robot, const JointPath& path) {
  return duration_of(time_at_rest(robot, path, 0).pieces);
}

std::size_t append_until(std::vector<TrajectoryPiece>& pieces,
                         std::span<const TrajectoryPiece> timing, double end) {
  // Shorter than this share of a piece, what is left of it is rounding.
  constexpr double kSliver = 1e-12;
  std::size_t count = 0;
  for (const TrajectoryPiece& whole : timing) {
    if (!(end > kSliver * whole.duration)) break;
    ++count;
    const double share = end / whole.duration;
    end -= whole.duration;
    pieces.push_back(share < 1.0 - kSliver ? whole.until(share * whole.duration) : whole);
  }
  return count;
}

namespace {

/// A section in windows; nothing where one was not joined to the next.
std::optional<Section> time_in_windows(const RobotModel& robot, const JointPath& path,
                                       std::size_t window) {
  const auto& all = path.pieces();
  PathTimer timer(robot);
  Section section;
  bool limits_tool = false;
  const auto keep = [&](const NumberedTiming& timing, const std::vector<ToolLimits>& tool,
                        double end) {
    const std::size_t count = append_until(section.pieces, timing.pieces, end);
    limits_tool = limits_tool || !tool.empty();
    for (std::size_t k = 0; k < count; ++k) {
      section.tool.push_back(tool.empty() ? ToolLimits() : tool[k]);
    }
  };
  for (std::size_t begin = 0; begin < all.size();) {
    // No window is left that is shorter than half.
    const std::size_t left = all.size() - begin;
    const std::size_t end = left < window + window / 2 ? all.size() : begin + window;
    JointPath part;
    for (; begin < end; ++begin) part.append(all[begin]);
    const NumberedTiming before = timer.timing();
    const std::vector<ToolLimits> tool_before = timer.tool();
    timer.append(part);
    keep(before, tool_before, timer.extend({}, 0.0));
    if (timer.stops() > 0) return std::nullopt;
  }
  keep(timer.timing(), timer.tool(), std::numeric_limits<double>::infinity());
  if (!limits_tool) section.tool.clear();
  return section;
}

}  // namespace

Section time_section(const RobotModel& robot, const JointPath& path) {
  const std::size_t whole = path.pieces().size();
  if (whole > kOneWindow) {
    if (auto section = time_in_windows(robot, path, kWindow)) return std::move(*section);
  }
  return *time_in_windows(robot, path, whole);
}

}  // namespace viapoint::planning
