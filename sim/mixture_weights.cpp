#include "sim/mixture_weights.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/mixture_weights.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/tables-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using noise::HWY_NAMESPACE::FloatTable16;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;
using Words = hn::Vec<hn::RebindToUnsigned<FloatTag>>;

// The mixture of sigma^2: its binary exponent, and 0 for all below 1/16.
HWY_INLINE Words MixtureOf(Floats variance, int mixtures) {
  const hn::RebindToSigned<FloatTag> d;
  const auto exponent =
      hn::ShiftRight<23>(hn::BitCast(d, variance));  // biased by 127; variance is not negative
  const auto index = hn::Sub(exponent, hn::Set(d, 127 - 5));
  return hn::BitCast(hn::RebindToUnsigned<FloatTag>(),
                     hn::Min(hn::Max(index, hn::Zero(d)), hn::Set(d, mixtures - 1)));
}

void MixtureWeights(const MixtureTables& tables, uint32_t in_use, std::span<const float> sigma_px,
                    float* const* weights) {
  const FloatTag d;
  const FloatTable16 scale(tables.scale.data()), offset(tables.offset.data());
  for (size_t i = 0; i < sigma_px.size(); i += hn::Lanes(d)) {
    const Floats sigma = hn::LoadU(d, sigma_px.data() + i), variance = hn::Mul(sigma, sigma);
    const Words mixture = MixtureOf(variance, tables.mixtures);
    const Floats t = hn::Add(hn::Mul(variance, scale[mixture]), offset[mixture]);
    Floats level[4], weight[4];
    for (size_t r = 0; r < 4; ++r) {
      const auto& cubic = tables.weight[r];
      level[r] = FloatTable16(tables.level[r].data())[mixture];
      weight[r] = FloatTable16(cubic[3].data())[mixture];
      for (size_t power = 3; power-- > 0;)
        weight[r] = hn::Add(hn::Mul(weight[r], t), FloatTable16(cubic[power].data())[mixture]);
    }
    for (int k = 0; k < tables.levels; ++k) {
      if (!(in_use >> k & 1)) continue;
      const Floats number = hn::Set(d, static_cast<float>(k));
      Floats sum = hn::Zero(d);
      for (size_t r = 0; r < 4; ++r)
        sum = hn::Add(sum, hn::IfThenElseZero(hn::Eq(level[r], number), weight[r]));
      hn::StoreU(sum, d, weights[k] + i);
    }
  }
}

void MixLevels(uint32_t in_use, const float* const* weights, const float* const* values,
               std::span<float> out) {
  const FloatTag d;
  for (size_t i = 0; i < out.size(); i += hn::Lanes(d)) {
    Floats sum = hn::Zero(d);
    for (uint32_t left = in_use; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      sum = hn::Add(sum, hn::Mul(hn::LoadU(d, weights[k] + i), hn::LoadU(d, values[k] + i)));
    }
    hn::StoreU(sum, d, out.data() + i);
  }
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {
namespace {

// As MixtureOf, of one value.
int MixtureOfOne(float sigma_px, int mixtures) {
  const auto exponent = static_cast<int>(std::bit_cast<uint32_t>(sigma_px * sigma_px) >> 23);
  return std::clamp(exponent - (127 - 5), 0, mixtures - 1);
}

}  // namespace

MixtureTables::MixtureTables(const LevelLadder& ladder)
    : mixtures(static_cast<int>(ladder.mixtures().size())),
      levels(static_cast<int>(ladder.levels().size())),
      scale{},
      offset{},
      level{},
      weight{} {
  for (size_t i = 0; i < ladder.mixtures().size(); ++i) {
    const BlurMixture& mixture = ladder.mixtures()[i];
    scale[i] = i == 0 ? 16.0f : std::ldexp(1.0f, 5 - static_cast<int>(i));
    offset[i] = i == 0 ? 0.0f : -1.0f;
    for (size_t r = 0; r < 4; ++r) {
      level[r][i] = static_cast<float>(mixture.level[r]);
      for (size_t power = 0; power < 4; ++power)
        weight[r][power][i] = static_cast<float>(mixture.weight[r][power]);
    }
  }
}

uint32_t LevelsInUse(const MixtureTables& tables, std::span<const float> sigma_px) {
  const auto [least, most] = std::ranges::minmax(sigma_px);
  uint32_t in_use = 0;
  const int last = MixtureOfOne(most, tables.mixtures);
  for (int i = MixtureOfOne(least, tables.mixtures); i <= last; ++i)
    for (size_t r = 0; r < 4; ++r) in_use |= 1u << static_cast<int>(tables.level[r][static_cast<size_t>(i)]);
  return in_use;
}

HWY_EXPORT(MixtureWeights);
HWY_EXPORT(MixLevels);

void MixtureWeights(const MixtureTables& tables, uint32_t in_use, std::span<const float> sigma_px,
                    float* const* weights) {
  HWY_DYNAMIC_DISPATCH(MixtureWeights)(tables, in_use, sigma_px, weights);
}
void MixLevels(uint32_t in_use, const float* const* weights, const float* const* values,
               std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixLevels)(in_use, weights, values, out);
}

}  // namespace shimmer::sim
#endif
