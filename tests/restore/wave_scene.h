// A scene for tests that can be evaluated at any place, seen through air that moves: shifts are exact.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace shimmer::restore {

// Waves of random direction and phase.
class Waves {
 public:
  // Wavelengths are spread evenly in their logarithm. The sum has that root mean square.
  Waves(uint32_t seed, int count, double shortest_px, double longest_px, double rms) {
    std::mt19937 random(seed);
    const auto unit = [&] { return std::ldexp(static_cast<double>(random()), -32); };
    for (int i = 0; i < count; ++i) {
      const double length = shortest_px * std::pow(longest_px / shortest_px, (i + unit()) / count);
      const double angle = 2 * std::numbers::pi * unit(), k = 2 * std::numbers::pi / length;
      waves_.push_back({k * std::cos(angle), k * std::sin(angle), 2 * std::numbers::pi * unit()});
    }
    height_ = rms * std::sqrt(2.0 / count);
  }

  double At(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.kx * x + wave.ky * y + wave.phase);
    return height_ * sum;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
  double height_;
};

struct View {
  cv::Size size;
  cv::Point2d shift = {};  // s: the scene's p is seen at p + s
  double tilt_rms_px = 0;  // along each axis, wavelengths from 20 px to 70 px
  uint32_t frame = 0;      // another one: other air, other noise
  double gain = 1, offset = 0;
  double noise = 0;         // root mean square, white
  cv::Rect box = {};        // in the frame: another texture, which moves with the box
  bool box_in_air = false;  // the air moves that texture too
};

// CV_32FC1 around 0.5, of root mean square 0.15 * gain.
inline cv::Mat SeenFrame(const View& view) {
  static const Waves scene(1, 40, 9, 120, 0.15), on_box(2, 10, 8, 30, 0.2);
  const Waves air_x(1000 + 2 * view.frame, 12, 20, 70, view.tilt_rms_px),
      air_y(1001 + 2 * view.frame, 12, 20, 70, view.tilt_rms_px);
  cv::Mat frame(view.size, CV_32FC1);
  cv::parallel_for_({0, view.size.height}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y)
      for (int x = 0; x < view.size.width; ++x) {
        cv::Point2d at(x - view.shift.x, y - view.shift.y);
        cv::Point2d on(x - view.box.x, y - view.box.y);
        if (view.tilt_rms_px > 0) {
          const cv::Point2d tilt(air_x.At(x, y), air_y.At(x, y));
          at += tilt;
          if (view.box_in_air) on += tilt;
        }
        const bool boxed = view.box.contains({x, y});
        const double light = boxed ? on_box.At(on.x, on.y) : scene.At(at.x, at.y);
        frame.at<float>(y, x) = static_cast<float>(0.5 + view.offset + view.gain * light);
      }
  });
  if (view.noise > 0) {
    cv::RNG random(view.frame + 1);
    cv::Mat noise(view.size, CV_32FC1);
    random.fill(noise, cv::RNG::NORMAL, 0, view.noise);
    frame += noise;
  }
  return frame;
}

// A camera that wanders: within `most` px of its first place along each axis, at (0, 0) in frame 0.
inline cv::Point2d WanderingShift(int frame, double most) {
  return {most * std::sin(0.37 * frame) * std::cos(0.05 * frame), most * std::sin(0.23 * frame)};
}

}  // namespace shimmer::restore
