/// @file
/// Straight legs whose points lie so near one longer leg that they make no corner: dense points of
/// a sampled curve, points on one line. Many short legs leave a corner no room, and each costs.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "planning/leg.hpp"

namespace viapoint::planning {

/// Takes legs one by one and gives them on, the last ones a little later: a run of straight legs of
/// the same kind and the same wishes becomes one leg while each point between them lies within
/// half its zone of that leg; the corners at its ends have only the rest of theirs. So every
/// place of the path keeps the zone's promise of the legs as they were told:
///  - the distance between the run and its leg, both ways, is the largest of a point, since the
///    distance from a segment is convex and the points go forward along it,
///  - what a corner deviates from the leg adds to it at most (triangle inequality),
///  - for a radius, no place of the leg is farther than that from the nearest point that has one.
/// What it does hangs on the legs alone, not on when they come.
class LegMerger {
 public:
  using Emit = std::function<void(Leg)>;
  /// @param emit takes the legs, in order
  LegMerger(const LineTolerance& tolerance, Emit emit)
      : tolerance_(tolerance), emit_(std::move(emit)) {}

  void add(Leg leg);
  /// What is held back cannot go on.
  void flush();
  /// From now on every leg is given on at once.
  void merge_nothing() {
    flush();
    merges_ = false;
  }

 private:
  /// How far the points of a run are from the leg from its start to its end.
  struct Offset {
    std::vector<double> point;       ///< distance of each inner point
    std::vector<double> turn;        ///< angle there [rad]
    double worst = 0.0;              ///< of all places; infinite where the points do not go forward
    double worst_turn = 0.0;         ///< of all places
    double longest = 0.0;            ///< distance of neighbouring points
    double first = 0.0, last = 0.0;  ///< of the ends from their neighbours
  };

  [[nodiscard]] static MergedPlace place_of(const Leg& leg, const JointVector& q);
  [[nodiscard]] static Offset offset_of(std::span<const MergedPlace> places);
  [[nodiscard]] bool goes_on_with(const Leg& leg);
  /// From the start of the run to its end; nothing where none can be made.
  [[nodiscard]] std::optional<Leg> one_leg() const;
  [[nodiscard]] std::optional<Leg> merged() const;

  LineTolerance tolerance_;
  Emit emit_;
  std::vector<Leg> run_;             ///< held back: one, or all that make one leg
  std::vector<MergedPlace> places_;  ///< its start and the ends of its legs
  bool merges_ = true;
  Zone before_;  ///< of the leg before the run
};

}  // namespace viapoint::planning
