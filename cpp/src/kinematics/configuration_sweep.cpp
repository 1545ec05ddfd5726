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
constexpr int kSteps = 40;
constexpr int kHalvings = 20;
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
      const double from = std::max(low, k * kTurn - kPi);
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

std::vector<JointVector> ConfigurationSweep::find(double low, double high, int count,
                                                  const JointVector& reference, const Solve& solve,
                                                  const Signs& signs, const Accept& accept) const {
  std::map<Key, Track> tracks;
  std::set<double> places;
  const auto take = [&](Track& track, const Place& place) {
    if (place.room < 0.0 || !limits_.contains(place.q)) return;
    if (track.best && track.best->margin >= place.margin) return;
    if (accept(place.q)) track.best = place;
  };
  const auto look = [&](double parameter) {
    ClosedSolutions found;
    solve(parameter, found);
    places.insert(parameter);
    std::set<Sides> existing;
    for (const ClosedBranch& branch : found.branches) {
      const Sides sides = signs(branch.sides);
      existing.insert(sides);
      each_turn(branch.q, reference, [&](const std::vector<int>& turns, const Place& place) {
        Track& track = tracks[{sides, turns}];
        const auto [known, first] = track.room.try_emplace(parameter, place.room);
        if (!first) known->second = std::max(known->second, place.room);
        take(track, place);
      });
    }
    return existing;
  };

  // Even places, and both sides of where a branch begins or ends between two of them.
  std::set<Sides> before;
  for (int i = 0; i <= count; ++i) {
    const double parameter = low + (high - low) * i / count;
    const std::set<Sides> here = look(parameter);
    if (i > 0 && here != before) {
      double left = low + (high - low) * (i - 1) / count;
      double right = parameter;
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (left + right);
        (look(middle) == before ? left : right) = middle;
      }
    }
    before = here;
  }

  for (auto& [key, track] : tracks) {
    const std::map<double, double> rooms = track.room;
    const auto room_at = [&](std::set<double>::const_iterator place) {
      const auto found = rooms.find(*place);
      return found == rooms.end() ? kNowhere : found->second;
    };
    for (const auto& [parameter, room] : rooms) {
      if (track.best) break;
      if (room < kHopeless) continue;
      const auto place = places.find(parameter);
      const auto left = place == places.begin() ? place : std::prev(place);
      const auto right = std::next(place) == places.end() ? place : std::next(place);
      if (room < room_at(left) || room < room_at(right)) continue;
      (void)refined_minimum(*left, *right, {parameter, -room}, kResolution, kSteps, [&](double at) {
        ClosedSolutions found;
        solve(at, found);
        double most = kNowhere;
        for (const ClosedBranch& branch : found.branches) {
          if (signs(branch.sides) != key.first) continue;
          const Place there = place_of(branch.q, reference, key.second);
          most = std::max(most, there.room);
          take(track, there);
        }
        return -most;
      });
    }
  }
  std::vector<JointVector> solutions;
  for (const auto& [key, track] : tracks) {
    if (track.best) solutions.push_back(track.best->q);
  }
  return solutions;
}

}  // namespace viapoint
