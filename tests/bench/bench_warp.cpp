// Milliseconds per 1080p frame of the warp on one core, for every kind of source and interpolation, beside
// cv::remap with the same shifts (5 px of tilt in 8 octaves), and the error of each against the double twin
// in 1/255 of the range; then what goes before and after it: preparing, packing, sRGB.
#include <benchmark/benchmark.h>

#include <tbb/global_control.h>

#include <opencv2/imgproc.hpp>

#include "noise/hash.h"
#include "sim/colour.h"
#include "sim/pack_rows.h"
#include "sim/tilt_field.h"
#include "sim/warp.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

constexpr int kHalo = 16, kBand = 64;
const cv::Size kSize(1920, 1080);

struct Shifts {
  cv::Mat_<float> dx{kSize}, dy{kSize};
};

const Shifts& TheShifts() {
  static const Shifts shifts = [] {
    Shifts s;
    TiltParams params;
    params.strength_px = 5;
    const TiltField field(params, {});
    for (int y = 0; y < kSize.height; ++y)
      field.Row(3, y, 0, {s.dx[y], size_t(kSize.width)}, {s.dy[y], size_t(kSize.width)});
    return s;
  }();
  return shifts;
}

// Sines and a little noise, so that interpolations differ as on a photograph.
cv::Mat CleanFrame(int type) {
  noise::HashStream stream(0);
  cv::Mat picture = Picture(kSize, kHalo, CV_MAT_CN(type), [&](int x, int y, int c) {
    return SumOfSines(x, y, c) + 0.05 * (noise::UnitFromBits(stream.Next()) - 0.5);
  });
  const double top = CV_MAT_DEPTH(type) == CV_8U ? 255 : CV_MAT_DEPTH(type) == CV_16U ? 65535 : 1;
  picture.convertTo(picture, type, top);
  return picture;
}

// at(x, y) in 1/255 against the twin, channel 0, on a grid of pixels.
template <class At>
void CountErrors(benchmark::State& state, const cv::Mat& clean, Interpolation interpolation, const At& at) {
  const Shifts& shifts = TheShifts();
  double squares = 0, max = 0;
  int points = 0;
  for (int y = 0; y < kSize.height; y += 7)
    for (int x = 0; x < kSize.width; x += 3, ++points) {
      const double twin = WarpDouble(clean, x + kHalo + double{shifts.dx(y, x)},
                                     y + kHalo + double{shifts.dy(y, x)}, 0, interpolation);
      const double error = 255 * std::abs(at(x, y) - twin);
      squares += error * error;
      max = std::max(max, error);
    }
  state.counters["rms"] = std::sqrt(squares / points);
  state.counters["max"] = max;
  state.SetItemsProcessed(state.iterations() * points * 21);
}

void Ours(benchmark::State& state, int type, Interpolation interpolation) {
  const Shifts& shifts = TheShifts();
  const cv::Mat clean = CleanFrame(type), source = PrepareForWarp(clean);
  const size_t width = kSize.width;
  std::vector<float> band(3 * kBand * width);
  cv::Mat_<float> kept(kSize);
  const auto warp = [&](int y) {
    float* const row = &band[3 * width * (y % kBand)];
    float* const planes[] = {row, row + width, row + 2 * width};
    WarpRow(source, {kHalo, y + kHalo}, {shifts.dx[y], width}, {shifts.dy[y], width}, interpolation, planes);
    return row;
  };
  for (auto _ : state)
    for (int y = 0; y < kSize.height; ++y) benchmark::DoNotOptimize(warp(y));
  for (int y = 0; y < kSize.height; ++y) std::copy_n(warp(y), width, kept[y]);
  CountErrors(state, clean, interpolation, [&](int x, int y) { return kept(y, x); });
}

void OpenCv(benchmark::State& state, int type, int flag, Interpolation interpolation) {
  const Shifts& shifts = TheShifts();
  const cv::Mat clean = CleanFrame(type);
  cv::Mat_<float> map_x(kSize), map_y(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      map_x(y, x) = x + kHalo + shifts.dx(y, x), map_y(y, x) = y + kHalo + shifts.dy(y, x);
  cv::Mat out;
  for (auto _ : state) cv::remap(clean, out, map_x, map_y, flag);
  cv::extractChannel(out, out, 0);
  out.convertTo(out, CV_32F, clean.depth() == CV_8U ? 1 / 255.0 : clean.depth() == CV_16U ? 1 / 65535.0 : 1);
  CountErrors(state, clean, interpolation, [&](int x, int y) { return out.at<float>(y, x); });
}

void Prepare(benchmark::State& state, int type) {
  const cv::Mat clean = CleanFrame(type);
  for (auto _ : state) benchmark::DoNotOptimize(PrepareForWarp(clean));
}

// f(row): of three planes, in place, row after row of the frame.
template <class F>
void Rows(benchmark::State& state, const F& f) {
  const size_t width = kSize.width;
  std::vector<float> band(3 * width * kBand);
  for (size_t i = 0; i < band.size(); ++i) band[i] = static_cast<float>(i % 1001) / 1000;
  for (auto _ : state)
    for (int y = 0; y < kSize.height; ++y) {
      f(&band[3 * width * (y % kBand)]);
      benchmark::ClobberMemory();
    }
}

template <class T>
void Pack(benchmark::State& state) {
  const size_t width = kSize.width;
  std::vector<T> to(3 * width);
  Rows(state, [&](const float* row) {
    PackRow(std::array{row, row + width, row + 2 * width}, 3, width, to.data());
  });
}

void Unpack(benchmark::State& state, int type) {
  const cv::Mat clean = CleanFrame(type);
  const size_t width = kSize.width;
  int y = 0;
  Rows(state, [&](float* row) {
    float* const planes[] = {row, row + width, row + 2 * width};
    UnpackRow(clean, {kHalo, kHalo + y++ % kSize.height}, width, planes);
  });
}

void Srgb(benchmark::State& state, void (*row_function)(std::span<float>)) {
  Rows(state, [&](float* row) {
    std::vector<float> copy(row, row + 3 * kSize.width);
    row_function(copy);
    benchmark::DoNotOptimize(copy.data());
  });
}

}  // namespace
}  // namespace shimmer::sim

int main(int argc, char** argv) {
  using namespace shimmer::sim;
  using benchmark::State;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  cv::setNumThreads(1);
  const auto add = [](const std::string& name, auto f) {
    benchmark::RegisterBenchmark(name.c_str(), f)->Unit(benchmark::kMillisecond);
  };
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3}) {
    const std::string name = cv::typeToString(type).substr(3);
    add("bicubic/" + name, [=](State& s) { Ours(s, type, Interpolation::kBicubic); });
    add("remap cubic/" + name, [=](State& s) { OpenCv(s, type, cv::INTER_CUBIC, Interpolation::kBicubic); });
    add("bilinear/" + name, [=](State& s) { Ours(s, type, Interpolation::kBilinear); });
    add("remap linear/" + name,
        [=](State& s) { OpenCv(s, type, cv::INTER_LINEAR, Interpolation::kBilinear); });
  }
  for (const int type : {CV_8UC3, CV_16UC3, CV_32FC3}) {
    const std::string name = cv::typeToString(type).substr(3);
    add("prepare/" + name, [=](State& s) { Prepare(s, type); });
    add("unpack/" + name, [=](State& s) { Unpack(s, type); });
  }
  add("pack/8UC3", Pack<uint8_t>);
  add("pack/16UC3", Pack<uint16_t>);
  add("pack/32FC3", Pack<float>);
  add("decode sRGB/32FC3", [](State& s) { Srgb(s, DecodeSrgbRow); });
  add("encode sRGB/32FC3", [](State& s) { Srgb(s, EncodeSrgbRow); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
