/// @file
/// The outputs of a program that is told while it runs, until the arm has passed them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "planning/itinerary.hpp"
#include "planning/output_places.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::planning {

/// An output is attached to every chunk of motion that its place is among, until a chunk is left
/// behind that place.
class PendingOutputs {
 public:
  void add(Output output) { pending_.push_back({std::move(output), std::nullopt, false}); }
  /// The chunk that attach() has seen last is left at `leave` [s of its own time] for another.
  /// @param last its pieces
  void leave(std::span<const TrajectoryPiece> last, double leave);
  /// As attach_outputs(), with what is pending.
  void attach(std::vector<TrajectoryPiece>& pieces, std::vector<ToolLimits>& tool,
              const Surroundings& around);
  /// The chunk that attach() has seen last is handed out.
  /// @param left of the chunk before, from where it is left to its end [s]
  void hand_out(const Trajectory& motion, double left);
  /// That chunk came too late: the arm has run the one before to its end.
  void miss();

  [[nodiscard]] std::size_t count() const { return pending_.size(); }
  /// True where every output has its place in what was handed out, and none comes after its end.
  [[nodiscard]] bool all_come() const;
  /// True where there is none to come but what has its place in what was handed out.
  [[nodiscard]] bool none_left() const { return pending_.empty() && !(due_after_ > 0.0); }
  /// Of the outputs that no motion follows, how long the last comes after the end [s]; at least 0.
  [[nodiscard]] double latest() const;

 private:
  struct Pending {
    Output output;
    std::optional<std::size_t> piece;  ///< of the chunk handed out last, where it changes
    bool in_tail = false;              ///< of the chunk before it, after that one was to be left
  };

  std::vector<Pending> pending_;   ///< in the order told
  double due_after_ = 0.0;         ///< how long after the chunk's end the last one comes [s]
  double due_after_before_ = 0.0;  ///< the same of the chunk before
};

}  // namespace viapoint::planning
