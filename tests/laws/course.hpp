/// @file
/// What every path and every motion is, seen from far enough: joints that change smoothly over one
/// parameter, piece by piece. The laws hold for all of them; a new type becomes subject to them by
/// one line in the list where its like are.
#pragma once

#include <array>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint::laws {

/// q and its first three derivatives by the parameter.
using Derivatives = std::array<JointVector, 4>;

struct Course {
  double length = 0.0;        ///< the parameter goes from 0 to here
  std::vector<double> knots;  ///< where pieces meet, without the ends
  std::function<Derivatives(double)> at;
  JointVector first, last;  ///< where it should begin and end
  int continuity = 2;       ///< derivatives up to this order are continuous at the knots
};

/// A subject of the laws: made when its test runs, not when tests are listed.
template <typename Thing>
struct Subject {
  std::string name;
  std::function<Thing()> make;

  friend std::ostream& operator<<(std::ostream& out, const Subject& subject) {
    return out << subject.name;
  }
};

/// The name of a subject, as GoogleTest wants to be told.
struct SubjectName {
  template <typename Info>
  std::string operator()(const Info& info) const {
    return info.param.name;
  }
};

/// `first` and then all of `more`.
template <typename T>
std::vector<T> joined(std::vector<T> first, const std::vector<T>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

/// The same subjects, with `suffix` to their names.
template <typename T>
std::vector<Subject<T>> named_after(std::vector<Subject<T>> subjects, const std::string& suffix) {
  for (Subject<T>& subject : subjects) subject.name += suffix;
  return subjects;
}

/// The same subjects, seen as something else.
template <typename To, typename From, typename View>
std::vector<Subject<To>> seen_as(const std::vector<Subject<From>>& subjects, View view) {
  std::vector<Subject<To>> result;
  for (const Subject<From>& subject : subjects) {
    result.push_back({subject.name, [make = subject.make, view] { return view(make()); }});
  }
  return result;
}

}  // namespace viapoint::laws
