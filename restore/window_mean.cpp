#include "restore/window_mean.h"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "restore/luck.h"
#include "restore/weighted_mean.h"

namespace shimmer::restore {
namespace {

constexpr float kEnough = 0.25f;   // share of the weights that needs no background before
constexpr float kNothing = 0.01f;  // share of the weights that is as good as nothing

template <class Sample>
const Sample* SamplesOf(const Part& part) {
  return reinterpret_cast<const Sample*>(part.row);
}

// What the parts of a piece come to: sums of samples times weights, these weights, and what the weights were
// if all were as lucky.
template <int kChannels>
struct Sums {
  std::array<float, kPiece_px * kChannels> sum{};
  std::array<float, kPiece_px> weights{}, shown{};
};

template <class Sample, int kChannels>
void AddPlain(const std::vector<Part>& parts, int px, Sums<kChannels>& sums) {
  float full = 0;                       // weights of all px of parts that have no mask
  std::array<const Sample*, 4> rows{};  // that wait for others, to be added at once
  std::array<float, 4> shares{};
  size_t waiting = 0;
  for (const Part& part : parts) {
    if (part.weight != nullptr) {
      AddWeighed<kChannels>(SamplesOf<Sample>(part), part.weight, part.gaussian, px, sums.sum.data(),
                            sums.weights.data());
      continue;
    }
    full += part.gaussian;
    rows[waiting] = SamplesOf<Sample>(part), shares[waiting] = part.gaussian;
    if (++waiting < rows.size()) continue;
    AddSamples(rows, shares, px * kChannels, sums.sum.data());
    waiting = 0;
  }
  for (size_t k = 0; k < waiting; ++k) AddSamples(rows[k], shares[k], px * kChannels, sums.sum.data());
  for (float& weight : sums.weights) weight += full;
  sums.shown = sums.weights;
}

template <class Sample, int kChannels>
void AddLucky(const std::vector<Part>& parts, int px, Sums<kChannels>& sums) {
  std::array<uint8_t, kPiece_px> luckiest{};  // of those that show the px
  for (const Part& part : parts)
    for (int x = 0; x < px; ++x)
      if (part.weight == nullptr || part.weight[x] != 0)
        luckiest[static_cast<size_t>(x)] = std::max(luckiest[static_cast<size_t>(x)], part.luck[x]);
  for (const Part& part : parts) {
    const auto* samples = SamplesOf<Sample>(part);
    for (int x = 0; x < px; ++x) {
      const auto at = static_cast<size_t>(x);
      const float shown =
          part.weight == nullptr ? part.gaussian : part.gaussian / 255 * static_cast<float>(part.weight[x]);
      const uint32_t less = luckiest[at] - std::min(part.luck[x], luckiest[at]);
      const float weight = shown * LuckWeight(less);
      sums.shown[at] += shown;
      sums.weights[at] += weight;
      for (int c = 0; c < kChannels; ++c)
        sums.sum[at * kChannels + static_cast<size_t>(c)] +=
            weight * static_cast<float>(samples[x * kChannels + c]);
    }
  }
}

// The mean of a piece of px, and where it is seen.
template <class Sample, int kChannels>
void MeanOf(const std::vector<Part>& parts, const Before& before, int px, uint8_t* to_bytes, uint8_t* seen) {
  Sums<kChannels> sums;
  if (parts[0].luck != nullptr)
    AddLucky<Sample, kChannels>(parts, px, sums);
  else
    AddPlain<Sample, kChannels>(parts, px, sums);
  float all = 0;
  for (const Part& part : parts) all += part.gaussian;

  auto* to = reinterpret_cast<Sample*>(to_bytes);
  const auto* last = reinterpret_cast<const Sample*>(before.row);
  std::array<float, kPiece_px * kChannels> as_they_are{};
  bool mixed = false;
  std::fill(seen, seen + px, uint8_t{255});
  for (int x = 0; x < px; ++x) {
    const auto at = static_cast<size_t>(x);
    const bool known = before.row != nullptr && before.seen[x] != 0;
    const float shown = sums.shown[at], missing = std::max(0.0f, (known ? kEnough : kNothing) * all - shown);
    if (!known && missing > 0 && !mixed) {
      for (const Part& part : parts)
        AddSamples(SamplesOf<Sample>(part), part.gaussian / all, px * kChannels, as_they_are.data());
      mixed = true;
    }
    // (the mean counts for as much as is shown of the px, however lucky that is)
    const float scale = sums.weights[at] > 0 ? shown / sums.weights[at] : 0;
    for (int i = x * kChannels; i < (x + 1) * kChannels; ++i) {
      const auto k = static_cast<size_t>(i);
      float value = sums.sum[k] * scale;
      if (missing > 0) value += missing * (known ? static_cast<float>(last[i]) : as_they_are[k]);
      to[i] = cv::saturate_cast<Sample>(value / (shown + missing));
    }
    if (!known && missing > 0) seen[x] = 0;
  }
}

template <class Sample>
MeanOfPiece MeanOfChannels(int channels) {
  return channels == 1 ? MeanOf<Sample, 1> : MeanOf<Sample, 3>;
}

}  // namespace

MeanOfPiece MeanOfType(int type) {
  const int channels = CV_MAT_CN(type);
  switch (CV_MAT_DEPTH(type)) {
    case CV_8U:
      return MeanOfChannels<uint8_t>(channels);
    case CV_16U:
      return MeanOfChannels<uint16_t>(channels);
    default:
      return MeanOfChannels<float>(channels);
  }
}

}  // namespace shimmer::restore
