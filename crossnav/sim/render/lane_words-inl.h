// SPDX-License-Identifier: MIT
// Words of records, one record a lane. Neighbouring pixels show one triangle or a few: then words
// are set and blended, where a gather would cost several times as much. Per target, as Highway has
// it: to be included after highway.h by files that are compiled once per instruction set. Internal.
#if defined(CROSSNAV_SIM_LANE_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CROSSNAV_SIM_LANE_WORDS_INL_H_
#undef CROSSNAV_SIM_LANE_WORDS_INL_H_
#else
#define CROSSNAV_SIM_LANE_WORDS_INL_H_
#endif

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {

template <class D>
class LaneWords {
  static_assert(hwy::HWY_NAMESPACE::MaxLanes(D()) <= 8);
  using I = hwy::HWY_NAMESPACE::Vec<D>;
  using M = hwy::HWY_NAMESPACE::Mask<D>;

 public:
  /// `first`: of each lane's record, its first word in `words`.
  HWY_INLINE LaneWords(const std::int32_t* words, I first) : words_(words), first_(first) {
    namespace hn = hwy::HWY_NAMESPACE;
    const D d;
    alignas(32) std::array<std::int32_t, 8> places;
    hn::Store(first, d, places.data());
    M seen = hn::Eq(first, hn::Set(d, places[0]));
    records_[0] = words + places[0];
    count_ = 1;
    for (std::size_t k = 1; !hn::AllTrue(d, seen); ++k) {
      ++count_;
      if (k == kFew) return;
      const auto lane = static_cast<std::size_t>(hn::FindKnownFirstTrue(d, hn::Not(seen)));
      records_[k] = words + places[lane];
      of_[k - 1] = hn::Eq(first, hn::Set(d, places[lane]));
      seen = hn::Or(seen, of_[k - 1]);
    }
  }

  /// True if all lanes have the same record.
  HWY_INLINE bool is_one() const { return count_ == 1; }

  HWY_INLINE I operator()(int k) const {
    namespace hn = hwy::HWY_NAMESPACE;
    const D d;
    if (count_ > kFew) return hn::GatherIndex(d, words_, hn::Add(first_, hn::Set(d, k)));
    I word = hn::Set(d, records_[0][k]);
    for (std::size_t i = 1; i < count_; ++i)
      word = hn::IfThenElse(of_[i - 1], hn::Set(d, records_[i][k]), word);
    return word;
  }

 private:
  static constexpr std::size_t kFew = 4;  // chosen: above this a gather is cheaper

  const std::int32_t* words_;
  I first_;
  std::size_t count_ = 0;  // of different records; kFew + 1: more
  std::array<const std::int32_t*, kFew> records_{};
  M of_[kFew - 1];  // lanes of the second record, of the third, ...
};

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // CROSSNAV_SIM_LANE_WORDS_INL_H_
