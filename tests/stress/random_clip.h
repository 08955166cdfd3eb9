// Clips anywhere in the ranges that the parameters state: the ends of a range as often as what lies between.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "noise/hash.h"
#include "sim/draw.h"
#include "sim/plan.h"

namespace shimmer::sim {

struct RandomClip {
  Scene scene;
  ClipShape shape;
  Accuracy accuracy;
  ClipKey key;
};

// A value in a field's range: an end, a listed one, uniform, or uniform in the logarithm.
class DrawFields {
 public:
  explicit DrawFields(noise::HashStream& stream) : stream_(stream) {}

  template <class Value>
  void operator()(const Field& field, Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      value = static_cast<Value>(stream_.Below(field.names.size()));
    } else if (!field.values.empty()) {
      value = static_cast<Value>(field.values[stream_.Below(field.values.size())]);
    } else {
      value = static_cast<Value>(Number(field.low, field.high));
    }
  }

 private:
  double Number(double low, double high) {
    const double unit = noise::UnitFromBits(stream_.Next());
    switch (stream_.Below(6)) {
      case 0:
        return low;
      case 1:
        return high;
      case 2:
        return low + (high - low) * unit;
      default: {
        const double least = std::max(low, 1e-12);
        return std::min(high, least * std::pow(high / least, unit));
      }
    }
  }

  noise::HashStream& stream_;
};

inline RandomClip DrawClip(uint64_t number, int most_px) {
  noise::HashStream stream(noise::HashPath(0, number, "stress"));
  RandomClip clip;
  DrawFields draw(stream);
  TiltParams::Fields(clip.scene.tilt, draw);
  BlurParams::Fields(clip.scene.blur, draw);
  Accuracy::Fields(clip.accuracy, draw);
  clip.scene.blur.min_sigma_px = std::min(clip.scene.blur.min_sigma_px, clip.scene.blur.max_sigma_px);
  clip.scene.still = stream.Below(2) == 0;
  clip.scene.colour = stream.Below(4) == 0 ? Colour::kLinear : Colour::kStored;
  const auto side = [&] { return 1 + static_cast<int>(stream.Below(static_cast<uint64_t>(most_px))); };
  clip.shape.size = {side(), side()};
  clip.shape.frames = 1 + static_cast<int>(stream.Below(40));
  constexpr int64_t kFar[] = {0, 1000000, 1000000000, (int64_t{1} << 31) - 40};
  clip.shape.first_frame = kFar[stream.Below(4)];
  clip.key = {stream.Below(2) == 0 ? 0 : stream.Next(), stream.Below(100000)};
  return clip;
}

}  // namespace shimmer::sim
