/// @file
#pragma once

#include <stdexcept>
#include <string>

namespace viapoint::fuzz {

/// What was taken is not what the reader promises: nothing catches this but the test.
struct BrokenPromise : std::logic_error {
  using std::logic_error::logic_error;
};

inline void promise(bool kept, const std::string& what) {
  if (!kept) throw BrokenPromise(what);
}

}  // namespace viapoint::fuzz
