// The method of the paper authors' simulator, for comparison: our own implementation of what is known of it
// (docs/model.md, "Where the authors' program departs from the paper, and from this"), in C++ where theirs is
// Python, on one thread.
//   tilt   one point at a time, 8 octaves of simplex noise in float32 with an origin of up to 500,000 cells
//          along each axis; fast mode: one field, which mirrored in time serves as the other axis; full mode:
//          two fields
//   warp   the nearest pixel below: whole pixels, whatever the shift
//   blur   11 cascaded cv::GaussianBlur; each pixel takes the nearest level below its sigma
//   sigma  from 11 octaves of Perlin noise alone, brought to [0, 1] by the frame's own least and largest
//   value
// The frame ends at its edge: places outside take the edge's pixel.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "noise/octaves.h"
#include "sim/scene.h"

namespace shimmer::bench {

enum class AuthorsMode { kFast, kFull };

// What the authors' own program took on one quiet core of the machine that Shimmer was developed on: quoted,
// not measured here.
inline constexpr double kAuthorsFastMs512 = 500, kAuthorsFullMs512 = 1000;  // a frame of 512x512
inline constexpr double kAuthorsFastFps200 = 17.6, kAuthorsFullFps200 = 7.6;

class AuthorsMethod {
 public:
  // Strength, frequencies, octaves, time scales and largest sigma as in scene; lacunarity 2, persistence 0.5.
  AuthorsMethod(const sim::Scene& scene, cv::Size size, int frames, AuthorsMode mode);

  struct Shifts {
    cv::Mat dx, dy;
  };
  std::vector<Shifts> ClipShifts() const;  // CV_32F, of all frames, in px
  cv::Mat SigmaMap(int t) const;           // CV_32F in px

  // clean: 1 or 3 channels, 8 bit or float, of the clip's size; so is the result.
  cv::Mat Warp(const cv::Mat& clean, const Shifts& shifts) const;
  cv::Mat Blur(const cv::Mat& warped, const cv::Mat& sigma) const;

  // All frames of the clip of a still.
  std::vector<cv::Mat> RenderClip(const cv::Mat& clean) const;

  // The same shifts and sigmas without rounding, CV_64F and CV_32F.
  Shifts ExactShifts(int t) const;
  cv::Mat ExactSigmaMap(int t) const;

 private:
  using Place = std::array<double, 3>;  // cells
  cv::Mat Field(const Place& origin, int t) const;
  cv::Mat ExactField(const Place& origin, int t) const;
  int Mirrored(int t) const { return frames_ - 1 - t; }

  sim::Scene scene_;
  cv::Size size_;
  int frames_;
  AuthorsMode mode_;
  Place origin_x_, origin_y_, blur_origin_;
};

}  // namespace shimmer::bench
