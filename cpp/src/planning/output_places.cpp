#include "planning/output_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "viapoint/core/number_text.hpp"

namespace viapoint::planning {
namespace {

/// Places this near to each other are one [s].
constexpr double kSameTime = 1e-6;
/// The path passes the point itself [m, rad].
constexpr double kAtPoint = 1e-9;
/// A way shorter than this is rest [m].
constexpr double kNoWay = 1e-12;
constexpr int kHalvings = 50;
/// How far from the middle of a corner its nearest place is looked for.
constexpr size_t kMostPieces = 64;

struct Place {
  size_t piece = 0;
  double tau = 0.0;  ///< since it began [s]
};

Eigen::Vector3d tool_velocity(const RobotModel& robot, const JointState& state) {
  const ChainFrames frames = robot.forward().frames(state.q);
  return (robot.forward().jacobian(frames) * state.qd).head<3>();
}

/// Way of the tool in a stretch of a piece [m], by Gauss's rule of five points in each quarter.
double way(const RobotModel& robot, const TrajectoryPiece& piece, double from, double to) {
  constexpr std::array kAt = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array kWeight = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  constexpr int kParts = 4;
  const double half = 0.5 * (to - from) / kParts;
  double sum = 0.0;
  for (int part = 0; part < kParts; ++part) {
    const double middle = from + (2 * part + 1) * half;
    for (size_t i = 0; i < kAt.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        if (i == 0 && side > 0.0) continue;
        const JointState state = piece.at(middle + side * kAt[i] * half);
        sum += kWeight[i] * tool_velocity(robot, state).norm();
      }
    }
  }
  return sum * half;
}

/// Finds the places of one output on the pieces.
class Finder {
 public:
  Finder(std::span<const TrajectoryPiece> pieces, const Output& output, const Surroundings& around)
      : pieces_(pieces), output_(output), around_(around) {}

  [[nodiscard]] std::optional<Place> find() {
    const std::optional<Place> point = find_point();
    if (!point) {
      // Where the move before it ends at rest, what comes before that is known already.
      const bool ends = around_.move_ends && pieces_.back().move == output_.leg;
      if (!ends || output_.distance >= 0.0) return std::nullopt;
      return back({pieces_.size() - 1, pieces_.back().duration}, -output_.distance);
    }
    if (output_.distance < 0.0) return back(*point, -output_.distance);
    if (output_.distance > 0.0) return ahead(*point, output_.distance);
    return point;
  }

  /// Where the path passes the point itself.
  [[nodiscard]] std::optional<Place> find_point() {
    const auto later = std::ranges::partition_point(
        pieces_, [this](const TrajectoryPiece& piece) { return piece.move <= output_.step; });
    first_ = static_cast<size_t>(later - pieces_.begin());
    if (first_ == pieces_.size()) return std::nullopt;
    return nearest();
  }

 private:
  /// From the point to the arm, and how fast it goes away.
  struct Distance {
    double squared = 0.0;
    double growth = 0.0;
  };

  [[nodiscard]] Distance distance(const Place& place) const {
    const JointState state = pieces_[place.piece].at(place.tau);
    const RobotModel& robot = *output_.robot;
    if (!robot.has_kinematics()) {
      const JointVector away = state.q - output_.point;
      return {away.squaredNorm(), away.dot(state.qd)};
    }
    const Eigen::Vector3d away = robot.forward().pose(state.q).translation() -
                                 robot.forward().pose(output_.point).translation();
    return {away.squaredNorm(), away.dot(tool_velocity(robot, state))};
  }

  /// Where the path passes nearest to the point: near to where the move under way changes.
  [[nodiscard]] Place nearest() const {
    const Place middle{first_, 0.0};
    const Distance there = distance(middle);
    if (there.squared < kAtPoint * kAtPoint || there.growth == 0.0) return middle;
    const bool is_ahead = there.growth < 0.0;
    if (!is_ahead && first_ == 0) return middle;
    const int move = pieces_[is_ahead ? first_ : first_ - 1].move;
    size_t piece = first_;
    for (size_t steps = 0; steps < kMostPieces; ++steps) {
      if (is_ahead ? piece == pieces_.size() : piece == 0) break;
      if (!is_ahead) --piece;
      if (pieces_[piece].move != move) break;
      const double end = is_ahead ? pieces_[piece].duration : 0.0;
      if ((distance({piece, end}).growth < 0.0) != is_ahead) return turning_point(piece);
      if (is_ahead) ++piece;
    }
    return middle;
  }

  /// Where in a piece the distance goes from falling to rising.
  [[nodiscard]] Place turning_point(size_t piece) const {
    double low = 0.0;
    double high = pieces_[piece].duration;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (distance({piece, middle}).growth < 0.0 ? low : high) = middle;
    }
    return {piece, low};
  }

  [[nodiscard]] Place back(const Place& from, double distance) const {
    size_t piece = from.piece;
    double tau = from.tau;
    double left = distance;
    std::optional<int> move;  // that ends at the point
    for (;;) {
      const double length = way(*output_.robot, pieces_[piece], 0.0, tau);
      if (length > kNoWay && piece < first_) {
        if (move && pieces_[piece].move != *move) refuse(distance - left, "before");
        move = pieces_[piece].move;
      }
      if (length >= left) return {piece, at_way(piece, tau, left, -1.0)};
      left -= length;
      if (piece == 0) break;
      tau = pieces_[--piece].duration;
    }
    if (around_.from_start) refuse(distance - left, "before");
    return {0, 0.0};
  }

  [[nodiscard]] std::optional<Place> ahead(const Place& from, double distance) const {
    double left = distance;
    std::optional<int> move;  // that begins at the point
    double tau = from.tau;
    for (size_t piece = from.piece; piece < pieces_.size(); ++piece, tau = 0.0) {
      const double end = pieces_[piece].duration;
      const double length = way(*output_.robot, pieces_[piece], tau, end);
      if (length > kNoWay && piece >= first_) {
        if (move && pieces_[piece].move != *move) refuse(distance - left, "after");
        move = pieces_[piece].move;
      }
      if (length >= left) return Place{piece, at_way(piece, tau, left, 1.0)};
      left -= length;
    }
    if (around_.to_end) refuse(distance - left, "after");
    return std::nullopt;
  }

  /// The time in a piece that lies `length` [m] of way from `tau`, in the direction of `side`.
  [[nodiscard]] double at_way(size_t piece, double tau, double length, double side) const {
    const TrajectoryPiece& all = pieces_[piece];
    double near = tau;
    double far = side > 0.0 ? all.duration : 0.0;
    double left = length;
    for (int i = 0; i < kHalvings && std::abs(far - near) > 0.01 * kSameTime; ++i) {
      const double middle = 0.5 * (near + far);
      const double part = way(*output_.robot, all, std::min(near, middle), std::max(near, middle));
      if (part <= left) {
        left -= part;
        near = middle;
      } else {
        far = middle;
      }
    }
    return near;
  }

  [[noreturn]] void refuse(double length, const char* side) const {
    Problem problem;
    problem.code = ErrorCode::kBadArgument;
    problem.message = "output " + std::to_string(output_.change.index) + " is to change " +
                      number_text(std::abs(output_.distance)) + " m " + side +
                      " its point, but the path of the move " + side + " it has only " +
                      number_text(length) + " m";
    problem.ways_out = {"give a shorter distance", "tell the output at another point"};
    problem.move = output_.step;
    problem.value = std::abs(output_.distance);
    problem.limit = length;
    throw MotionError(std::move(problem));
  }

  std::span<const TrajectoryPiece> pieces_;
  const Output& output_;
  const Surroundings& around_;
  size_t first_ = 0;  ///< piece of a later step
};

/// When each output comes, at full speed; what is told later must not come earlier, or one would
/// undo the other. Where two points share a corner the later one gives way.
void keep_order(std::span<const TrajectoryPiece> pieces, std::span<const Output> outputs,
                std::span<std::optional<Place>> places) {
  std::vector<double> starts(pieces.size());
  double time = 0.0;
  for (size_t k = 0; k < pieces.size(); ++k) {
    starts[k] = time;
    time += pieces[k].duration;
  }
  struct Last {
    double time = -std::numeric_limits<double>::infinity();
    double place = -std::numeric_limits<double>::infinity();
    std::optional<Place> where;
  };
  std::array<Last, kDigitalOutputs> last;
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (!places[i]) continue;
    const OutputChange& change = outputs[i].change;
    Last& before = last[static_cast<size_t>(change.index)];
    const bool is_plain = outputs[i].distance == 0.0 && change.time == 0.0;
    if (is_plain && before.where && starts[places[i]->piece] + places[i]->tau < before.place) {
      places[i] = before.where;
    }
    const double place = starts[places[i]->piece] + places[i]->tau;
    const double at = place + change.time;
    if (at < before.time - kSameTime || place < before.place - kSameTime) {
      Problem problem;
      problem.code = ErrorCode::kBadArgument;
      problem.message = "this change of output " + std::to_string(change.index) +
                        " would come before the one that is told before it";
      problem.ways_out = {"tell shorter distances and times", "tell the two in the other order"};
      problem.move = outputs[i].step;
      problem.time = at;
      throw MotionError(std::move(problem));
    }
    before = {at, place, places[i]};
  }
}

/// Takes the pieces over one by one, cut where outputs change.
class Cutter {
 public:
  Cutter(std::span<const TrajectoryPiece> pieces, std::span<const ToolLimits> tool)
      : pieces_(pieces), tool_(tool) {}

  /// @param place not before the one of the last call
  size_t attach(const Place& place, const OutputChange& change) {
    while (done_ < place.piece) finish_piece();
    begin_piece();
    double tau = place.tau - begun_;
    if (out_.back().duration - tau <= kSameTime && done_ + 1 < pieces_.size()) {
      finish_piece();
      begin_piece();
      tau = 0.0;
    }
    if (tau > kSameTime) {
      const TrajectoryPiece rest = out_.back().from(tau);
      out_.back() = out_.back().until(tau);
      push(rest);
      begun_ += tau;
    }
    while (out_.back().outputs == kMaxOutputsAPiece && done_ + 1 < pieces_.size()) {
      finish_piece();
      begin_piece();
    }
    TrajectoryPiece& piece = out_.back();
    if (piece.outputs == kMaxOutputsAPiece) {
      throw MotionError(
          ErrorCode::kBadArgument,
          "more than " + std::to_string(kMaxOutputsAPiece) + " outputs change at one point",
          {"put a short wait(0.01) between them"});
    }
    piece.output[static_cast<size_t>(piece.outputs++)] = change;
    return out_.size() - 1;
  }

  void finish(std::vector<TrajectoryPiece>& pieces, std::vector<ToolLimits>& tool) {
    while (done_ < pieces_.size()) finish_piece();
    pieces = std::move(out_);
    tool = std::move(out_tool_);
  }

 private:
  void begin_piece() {
    if (!std::exchange(is_begun_, true)) push(pieces_[done_]);
  }
  void finish_piece() {
    begin_piece();
    ++done_;
    is_begun_ = false;
    begun_ = 0.0;
  }
  void push(const TrajectoryPiece& piece) {
    out_.push_back(piece);
    if (!tool_.empty()) out_tool_.push_back(tool_[done_]);
  }

  std::span<const TrajectoryPiece> pieces_;
  std::span<const ToolLimits> tool_;
  size_t done_ = 0;        ///< pieces taken over
  bool is_begun_ = false;  ///< the one after them has been taken, or a part of it
  double begun_ = 0.0;     ///< where in it its last part begins [s]
  std::vector<TrajectoryPiece> out_;
  std::vector<ToolLimits> out_tool_;
};

}  // namespace

std::vector<std::optional<size_t>> attach_outputs(std::vector<TrajectoryPiece>& pieces,
                                                  std::vector<ToolLimits>& tool,
                                                  std::span<const Output> outputs,
                                                  const Surroundings& around) {
  std::vector<std::optional<size_t>> attached(outputs.size());
  if (pieces.empty() || outputs.empty()) return attached;
  std::vector<std::optional<Place>> places;
  std::uint64_t open = 0;  // outputs of which a change is not known yet
  for (const Output& output : outputs) {
    const std::uint64_t bit = std::uint64_t{1} << output.change.index;
    places.push_back((open & bit) != 0 ? std::nullopt : Finder(pieces, output, around).find());
    if (!places.back()) open |= bit;
  }
  keep_order(pieces, outputs, places);

  std::vector<size_t> order;
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (places[i]) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](size_t a, size_t b) {
    return std::pair(places[a]->piece, places[a]->tau) <
           std::pair(places[b]->piece, places[b]->tau);
  });
  const std::vector<TrajectoryPiece> whole = std::move(pieces);
  const std::vector<ToolLimits> whole_tool = std::move(tool);
  Cutter cutter(whole, whole_tool);
  for (const size_t i : order) attached[i] = cutter.attach(*places[i], outputs[i].change);
  cutter.finish(pieces, tool);
  return attached;
}

void move_point(Output& output, std::span<const TrajectoryPiece> pieces, double end) {
  if (pieces.empty()) return;
  const std::optional<Place> point = Finder(pieces, output, {}).find_point();
  if (!point) return;
  double start = 0.0;
  for (size_t k = 0; k < pieces.size() && start < end; ++k) {
    const TrajectoryPiece& piece = pieces[k];
    const double until = std::min(end - start, piece.duration);
    const double from = k == point->piece ? point->tau : 0.0;
    start += piece.duration;
    if (k < point->piece || until <= from) continue;
    if (output.distance > 0.0) {
      const double passed = way(*output.robot, piece, from, until);
      output.distance = std::max(output.distance - passed, kNoWay);
    }
    output.point = piece.at(until).q;
  }
}

}  // namespace viapoint::planning
