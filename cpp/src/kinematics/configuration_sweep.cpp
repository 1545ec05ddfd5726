#include "kinematics/configuration_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "kinematics/joint_turns.hpp"
#include "viapoint/core/scalar_minimum.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr double kTurn = 2.0 * kPi;
constexpr double kNowhere = -10.0;  ///< room of a branch that does not exist [rad]
constexpr double kHopeless = -1.0;  ///< summits below this are not climbed [rad]
constexpr double kEdge = 1e-10;     ///< -π itself is the last of the turn before [rad]
constexpr int kSteps = 40;
constexpr int kHalvings = 20;
constexpr int kHalves = 14;           ///< a stretch is looked at in up to 2^this parts
constexpr double kLeastMove = 0.01;   ///< of a stretch that is halved [rad]
constexpr double kResolution = 1e-6;  ///< of the parameter [rad]

}  // namespace

ConfigurationSweep::ConfigurationSweep(const ForwardKinematics& forward, const JointLimits& limits)
    : limits_(limits) {
  for (int i = 0; i < forward.joints(); ++i) {
    slides_.push_back(forward.type(i) == JointType::kPrismatic);
    windows_.emplace_back();
    const double low = limits.position_min[i];
    const double high = limits.position_max[i];
    if (slides_.back() || high - low >= kTurn) continue;  // open limits, too
    for (double k = std::ceil((low - kPi) / kTurn); k * kTurn - kPi < high; k += 1.0) {
      const double from = std::max(low, k * kTurn - kPi + kEdge);
      const double to = std::min(high, k * kTurn + kPi);
      if (to > from) windows_.back().push_back({0.5 * (from + to), 0.5 * (to - from)});
    }
  }
}

ConfigurationSweep::Place ConfigurationSweep::place_of(const JointVector& branch,
                                                       const JointVector& reference,
                                                       const std::vector<int>& turns) const {
  Place place;
  place.q = branch;
  place.room = kPi;
  place.margin = 0.5;
  for (int i = 0; i < branch.size(); ++i) {
    const auto k = static_cast<size_t>(i);
    const double low = limits_.position_min[i];
    const double high = limits_.position_max[i];
    double& q = place.q[i];
    if (slides_[k]) {
      place.room = std::min({place.room, q - low, high - q});
    } else if (windows_[k].empty()) {  // any angle has a turn within the limits: no end to run into
      q = wrap_near(q, std::max(low + kPi, std::min(reference[i], high - kPi)));
      q = std::max(low, std::min(q, high));
    } else {
      const Window& window = windows_[k][static_cast<size_t>(turns[k])];
      const double off = std::remainder(q - window.middle, kTurn);
      q = window.middle + off;
      place.room = std::min(place.room, window.half - std::abs(off));
    }
    if (std::isfinite(high - low)) {
      place.margin = std::min(place.margin, std::min(q - low, high - q) / (high - low));
    }
  }
  if (limits_.couplings() > 0) {
    const CouplingVector value = limits_.coupling * place.q;
    place.room = std::min({place.room, (value - limits_.coupling_lower).minCoeff(),
                           (limits_.coupling_upper - value).minCoeff()});
  }
  return place;
}

template <typename Visit>
void ConfigurationSweep::each_turn(const JointVector& branch, const JointVector& reference,
                                   Visit&& visit) const {
  std::vector<int> turns(windows_.size(), 0);
  while (true) {
    visit(turns, place_of(branch, reference, turns));
    size_t joint = 0;
    while (joint < turns.size() && ++turns[joint] >= static_cast<int>(windows_[joint].size())) {
      turns[joint++] = 0;
    }
    if (joint == turns.size()) return;
  }
}

/// One sweep: what was seen so far.
class ConfigurationSweep::Walk {
 public:
  Walk(const ConfigurationSweep& sweep, const JointVector& reference, const Solve& solve,
       const Signs& signs, const Accept& accept)
      : sweep_(sweep), reference_(reference), solve_(solve), signs_(signs), accept_(accept) {}

  void look_evenly(double low, double high, int count);
  void halve_where_room_may_rise();
  void climb_summits();
  [[nodiscard]] std::vector<JointVector> solutions() const;

 private:
  /// What there is at one parameter.
  struct Sight {
    double parameter = 0.0;
    std::set<Sides> existing;
    double near_miss = 0.0;  ///< [m]
  };
  Sight look(double parameter);
  void take(Track& track, const Place& place) const;
  /// Looks at both sides of where a branch begins or ends between two places.
  void bisect(const Sight& left, const Sight& right);
  /// Looks for a branch that neither of the three places has.
  void seek_missing(const Sight& left, const Sight& middle, const Sight& right);
  void halve(const Track& track, double left, double right, int depth);

  const ConfigurationSweep& sweep_;
  const JointVector& reference_;
  const Solve& solve_;
  const Signs& signs_;
  const Accept& accept_;
  std::map<Key, Track> tracks_;
  std::set<double> parameters_;
};

void ConfigurationSweep::Walk::take(Track& track, const Place& place) const {
  if (place.room < 0.0 || !sweep_.limits_.contains(place.q)) return;
  if (track.best && track.best->margin >= place.margin) return;
  if (accept_(place.q)) track.best = place;
}

ConfigurationSweep::Walk::Sight ConfigurationSweep::Walk::look(double parameter) {
  ClosedSolutions found;
  solve_(parameter, found);
  parameters_.insert(parameter);
  Sight sight{parameter, {}, found.near_miss};
  for (const ClosedBranch& branch : found.branches) {
    const Sides sides = signs_(branch.sides);
    sight.existing.insert(sides);
    sweep_.each_turn(branch.q, reference_, [&](const std::vector<int>& turns, const Place& place) {
      Track& track = tracks_[{sides, turns}];
      const auto [known, first] = track.places.try_emplace(parameter, place);
      if (!first && known->second.room < place.room) known->second = place;
      take(track, place);
    });
  }
  return sight;
}

void ConfigurationSweep::Walk::bisect(const Sight& left, const Sight& right) {
  if (left.existing == right.existing) return;
  double from = left.parameter;
  double to = right.parameter;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (from + to);
    (look(middle).existing == left.existing ? from : to) = middle;
  }
}

void ConfigurationSweep::Walk::seek_missing(const Sight& left, const Sight& middle,
                                            const Sight& right) {
  const auto higher = [&](const Sight& other) {
    return other.near_miss == 0.0 || other.near_miss >= middle.near_miss;
  };
  if (middle.near_miss == 0.0 || !higher(left) || !higher(right)) return;
  std::optional<double> there;
  (void)refined_minimum(left.parameter, right.parameter, {middle.parameter, middle.near_miss},
                        kResolution, kSteps, [&](double at) {
                          if (there) return 0.0;
                          ClosedSolutions found;
                          solve_(at, found);
                          for (const ClosedBranch& branch : found.branches) {
                            const Sides sides = signs_(branch.sides);
                            if (!left.existing.contains(sides) &&
                                !middle.existing.contains(sides) &&
                                !right.existing.contains(sides)) {
                              there = at;
                            }
                          }
                          return found.near_miss;
                        });
  if (!there) return;
  const Sight found = look(*there);
  const bool before = *there < middle.parameter;
  bisect(before ? left : middle, found);
  bisect(found, before ? middle : right);
}

void ConfigurationSweep::Walk::look_evenly(double low, double high, int count) {
  std::vector<Sight> sights;
  for (int i = 0; i <= count; ++i) {
    sights.push_back(look(low + (high - low) * i / count));
    const auto here = sights.end() - 1;
    if (i > 0) bisect(here[-1], *here);
    if (i > 1) seek_missing(here[-2], here[-1], *here);
  }
}

void ConfigurationSweep::Walk::halve(const Track& track, double left, double right, int depth) {
  const auto from = track.places.find(left);
  const auto to = track.places.find(right);
  if (from == track.places.end() || to == track.places.end() || track.best || depth == 0) return;
  double moved = 0.0;
  for (int i = 0; i < from->second.q.size(); ++i) {
    const double apart = to->second.q[i] - from->second.q[i];
    const bool slides = sweep_.slides_[static_cast<size_t>(i)];
    moved = std::max(moved, std::abs(slides ? apart : std::remainder(apart, kTurn)));
  }
  if (from->second.room + to->second.room + moved <= 0.0 || moved < kLeastMove) return;
  const double middle = 0.5 * (left + right);
  look(middle);
  halve(track, left, middle, depth - 1);
  halve(track, middle, right, depth - 1);
}

void ConfigurationSweep::Walk::halve_where_room_may_rise() {
  std::vector<Key> keys;
  for (const auto& [key, track] : tracks_) keys.push_back(key);
  for (const Key& key : keys) {
    const std::vector<double> parameters(parameters_.begin(), parameters_.end());
    for (size_t i = 1; i < parameters.size() && !tracks_[key].best; ++i) {
      halve(tracks_[key], parameters[i - 1], parameters[i], kHalves);
    }
  }
}

void ConfigurationSweep::Walk::climb_summits() {
  for (auto& [key, track] : tracks_) {
    const std::map<double, Place>& seen = track.places;
    const auto room_at = [&](std::set<double>::const_iterator place) {
      const auto found = seen.find(*place);
      return found == seen.end() ? kNowhere : found->second.room;
    };
    for (const auto& [parameter, here] : seen) {
      if (track.best) break;
      const double room = here.room;
      if (room < kHopeless) continue;
      const auto place = parameters_.find(parameter);
      const auto left = place == parameters_.begin() ? place : std::prev(place);
      const auto right = std::next(place) == parameters_.end() ? place : std::next(place);
      if (room < room_at(left) || room < room_at(right)) continue;
      (void)refined_minimum(*left, *right, {parameter, -room}, kResolution, kSteps, [&](double at) {
        ClosedSolutions found;
        solve_(at, found);
        double most = kNowhere;
        for (const ClosedBranch& branch : found.branches) {
          if (signs_(branch.sides) != key.first) continue;
          const Place there = sweep_.place_of(branch.q, reference_, key.second);
          most = std::max(most, there.room);
          take(track, there);
        }
        return -most;
      });
    }
  }
}

std::vector<JointVector> ConfigurationSweep::Walk::solutions() const {
  std::vector<JointVector> out;
  for (const auto& [key, track] : tracks_) {
    if (track.best) out.push_back(track.best->q);
  }
  return out;
}

std::vector<JointVector> ConfigurationSweep::find(double low, double high, int count,
                                                  const JointVector& reference, const Solve& solve,
                                                  const Signs& signs, const Accept& accept) const {
  Walk walk(*this, reference, solve, signs, accept);
  walk.look_evenly(low, high, count);
  walk.halve_where_room_may_rise();
  walk.climb_summits();
  return walk.solutions();
}

}  // namespace viapoint
