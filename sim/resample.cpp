#include "sim/resample.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/resample.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class T>
HWY_INLINE hn::Vec<D> LoadAsDoubles(D d, const T* from) {
  const auto samples = hn::LoadU(hn::Rebind<T, D>(), from);
  if constexpr (std::is_same_v<T, float>)
    return hn::PromoteTo(d, samples);
  else
    return hn::PromoteTo(d, hn::PromoteTo(hn::Rebind<int32_t, D>(), samples));
}

// out[i] = sum_k weights[k] rows[k][i]
template <class T>
HWY_INLINE void MixRowsOf(std::span<const double> weights, const T* const* rows, std::span<float> out) {
  const auto mix = [&](auto d, size_t i) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (size_t k = 0; k < weights.size(); ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), LoadAsDoubles(d, rows[k] + i)));
    hn::StoreU(hn::DemoteTo(hn::Rebind<float, decltype(d)>(), sum), hn::Rebind<float, decltype(d)>(),
               out.data() + i);
  };
  const hn::ScalableTag<double> d;
  const hn::CappedTag<double, 1> one;
  size_t i = 0;
  for (; i + hn::Lanes(d) <= out.size(); i += hn::Lanes(d)) mix(d, i);
  for (; i < out.size(); ++i) mix(one, i);
}

void MixRows8(std::span<const double> weights, const uint8_t* const* rows, std::span<float> out) {
  MixRowsOf(weights, rows, out);
}
void MixRows16(std::span<const double> weights, const uint16_t* const* rows, std::span<float> out) {
  MixRowsOf(weights, rows, out);
}
void MixRowsFloat(std::span<const double> weights, const float* const* rows, std::span<float> out) {
  MixRowsOf(weights, rows, out);
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {
namespace {

HWY_EXPORT(MixRows8);
HWY_EXPORT(MixRows16);
HWY_EXPORT(MixRowsFloat);

void MixRows(std::span<const double> weights, const uint8_t* const* rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixRows8)(weights, rows, out);
}
void MixRows(std::span<const double> weights, const uint16_t* const* rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixRows16)(weights, rows, out);
}
void MixRows(std::span<const double> weights, const float* const* rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixRowsFloat)(weights, rows, out);
}

// Which samples along an axis make one pixel: these from `first` on.
struct Taps {
  int first;
  std::vector<double> weights;
};

// Places are whole multiples of 1 / (2 resized) of a sample: exact, with nothing to round.
Taps MeanTaps(int64_t pixel, int64_t size, int64_t resized) {
  const int64_t begin = pixel * size, end = begin + size;  // of the pixel; a sample is `resized` long
  Taps taps{static_cast<int>(begin / resized), {}};
  for (int64_t sample = taps.first; sample * resized < end; ++sample) {
    const int64_t covered = std::min((sample + 1) * resized, end) - std::max(sample * resized, begin);
    taps.weights.push_back(static_cast<double>(covered) / static_cast<double>(size));
  }
  return taps;
}

Taps BicubicTaps(int64_t pixel, int64_t size, int64_t resized) {
  constexpr double a = -0.75;
  const int64_t unit = 2 * resized, place = (2 * pixel + 1) * size - resized;
  const int64_t whole = (place + unit) / unit - 1;  // rounded down: place is above -unit
  const double t = static_cast<double>(place - whole * unit) / static_cast<double>(unit), u = 1 - t;
  const double weights[] = {a * t * u * u, ((a + 2) * t - (a + 3)) * t * t + 1,
                            ((a + 2) * u - (a + 3)) * u * u + 1, a * u * t * t};
  const auto inside = [&](int64_t sample) { return std::clamp<int64_t>(sample, 0, size - 1); };
  Taps taps{static_cast<int>(inside(whole - 1)), {}};
  taps.weights.resize(inside(whole + 2) - taps.first + 1);
  for (int64_t k = 0; k < 4; ++k) taps.weights[inside(whole - 1 + k) - taps.first] += weights[k];
  return taps;
}

std::vector<Taps> TapsOf(int first, int count, int size, int resized) {
  std::vector<Taps> taps;
  for (int pixel = first; pixel < first + count; ++pixel)
    taps.push_back(resized <= size ? MeanTaps(pixel, size, resized) : BicubicTaps(pixel, size, resized));
  return taps;
}

int EndOf(const Taps& taps) { return taps.first + static_cast<int>(taps.weights.size()); }

// mixed begins with sample `first` of the row.
template <int channels>
void MixColumns(const std::vector<Taps>& columns, int first, const float* mixed, float* out) {
  for (const Taps& column : columns) {
    const float* from = mixed + static_cast<ptrdiff_t>(column.first - first) * channels;
    double sums[channels] = {};
    for (const double weight : column.weights)
      for (int c = 0; c < channels; ++c) sums[c] += weight * *from++;
    for (const double sum : sums) *out++ = static_cast<float>(sum);
  }
}

template <class T>
cv::Mat Resized(const cv::Mat& samples, const std::vector<Taps>& columns, std::vector<Taps> rows) {
  if constexpr (!std::is_same_v<T, float>)
    for (Taps& row : rows)
      for (double& weight : row.weights) weight /= std::numeric_limits<T>::max();
  const int channels = samples.channels(), first = columns.front().first;
  const auto mix_columns = channels == 1 ? MixColumns<1> : MixColumns<3>;
  std::vector<float> mixed(static_cast<size_t>(EndOf(columns.back()) - first) * channels);
  std::vector<const T*> from;
  cv::Mat out(static_cast<int>(rows.size()), static_cast<int>(columns.size()), CV_32FC(channels));
  for (int y = 0; y < out.rows; ++y) {
    from.clear();
    for (int row = rows[y].first; row < EndOf(rows[y]); ++row)
      from.push_back(samples.ptr<T>(row) + static_cast<ptrdiff_t>(first) * channels);
    MixRows(rows[y].weights, from.data(), mixed);
    mix_columns(columns, first, mixed.data(), out.ptr<float>(y));
  }
  return out;
}

void Require(bool fine, const std::string& what) {
  if (!fine) throw std::invalid_argument("resized part: " + what);
}

}  // namespace

cv::Mat ResizedPart(const cv::Mat& samples, cv::Size resized, cv::Rect part) {
  Require(!samples.empty() && (samples.channels() == 1 || samples.channels() == 3),
          "the picture must have pixels of 1 or 3 channels");
  Require(!part.empty() && (part & cv::Rect({}, resized)) == part, "must be pixels of the resized picture");
  const std::vector<Taps> columns = TapsOf(part.x, part.width, samples.cols, resized.width),
                          rows = TapsOf(part.y, part.height, samples.rows, resized.height);
  switch (samples.depth()) {
    case CV_8U:
      return Resized<uint8_t>(samples, columns, rows);
    case CV_16U:
      return Resized<uint16_t>(samples, columns, rows);
    case CV_32F:
      return Resized<float>(samples, columns, rows);
    default:
      throw std::invalid_argument("resized part: of type " + cv::typeToString(samples.type()) +
                                  ", must be CV_8U, CV_16U or CV_32F");
  }
}

}  // namespace shimmer::sim
#endif
