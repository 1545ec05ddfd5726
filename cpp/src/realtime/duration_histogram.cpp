#include "realtime/duration_histogram.hpp"

#include <algorithm>
#include <bit>

namespace viapoint {
namespace {

constexpr double kNanosecond = 1e-9;
constexpr int kBits = 7;                        ///< of a duration that a bucket tells apart
constexpr std::uint64_t kBucketsAnOctave = 64;  ///< 2^(kBits - 1)

std::size_t bucket_of(std::uint64_t duration) {
  const int shift = std::max(0, static_cast<int>(std::bit_width(duration)) - kBits);
  return static_cast<std::size_t>(static_cast<std::uint64_t>(shift) * kBucketsAnOctave +
                                  (duration >> shift));
}

std::uint64_t largest_in(std::size_t bucket) {
  if (bucket < 2 * kBucketsAnOctave) return bucket;
  const std::uint64_t shift = bucket / kBucketsAnOctave - 1;
  return ((bucket - shift * kBucketsAnOctave + 1) << shift) - 1;
}

}  // namespace

void DurationHistogram::add(std::int64_t duration) {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(duration, 0));
  const std::size_t bucket = bucket_of(value);
  if (bucket >= counts_.size()) counts_.resize(bucket + 1);
  ++counts_[bucket];
  ++total_;
  largest_ = std::max(largest_, value);
}

double DurationHistogram::quantile(std::uint64_t percent) const {
  if (total_ == 0) return 0.0;
  const std::uint64_t rank = (total_ - 1) * percent / 100;
  std::uint64_t below = 0;
  std::size_t bucket = 0;
  while ((below += counts_[bucket]) <= rank) ++bucket;
  const std::uint64_t value = percent == 100 ? largest_ : std::min(largest_in(bucket), largest_);
  return kNanosecond * static_cast<double>(value);
}

}  // namespace viapoint
