/// @file
/// How many random problems a test takes.
#pragma once

namespace viapoint {

/// All of `whole`, or a tenth of them under a sanitizer: what that looks for, a stray pointer or a
/// race, does not hide in the numbers, and it makes each problem many times slower. The plain build
/// runs them all.
template <class Count>
constexpr Count problems(Count whole) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (whole + 9) / 10;
#else
  return whole;
#endif
}

}  // namespace viapoint
