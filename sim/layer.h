// A picture that covers part of a frame: light times coverage, and the coverage.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::sim {

struct Layer {
  cv::Rect area;  // px of the clip's frame; may lie outside of it
  cv::Mat rgba;   // CV_32FC4 of that size: red, green and blue times alpha, and alpha, in [0, 1]
};

// Wide enough for whatever is drawn, and for sums of its coordinates: as `within` it leaves nothing out.
inline const cv::Rect kEverywhere(-(1 << 28), -(1 << 28), 1 << 29, 1 << 29);

// The pixels within an area that [low, high] touches, px, however far these are: what of a thing is seen.
cv::Rect PixelsWithin(cv::Rect within, cv::Point2d low, cv::Point2d high);

// Layers, from the farthest to the nearest, as layers that do not meet: those whose areas do are one, the
// nearer over the farther (out = near + (1 - alpha_near) far).
std::vector<Layer> Flattened(std::vector<Layer> layers);

// The layer over a frame whose pixel (0, 0) is pixel `origin` of the clip's: light = rgb + (1 - alpha) light.
// frame: CV_8U (v / 255), CV_16U (v / 65535) or CV_32F of 3 channels, or of 1 (the mean of the layer's
// three). linear_light: the frame is stored as sRGB, and the light is what that encodes. Rounded once; pixels
// of coverage 0 keep their bits. What lies outside of the frame is left out. Throws std::invalid_argument for
// other types.
void Composite(const Layer& layer, cv::Point origin, bool linear_light, cv::Mat& frame);

// mask = alpha + (1 - alpha) mask; CV_32FC1.
void AddCoverage(const Layer& layer, cv::Point origin, cv::Mat& mask);

// The mean of layers that an object has at several times: motion blur. At least one.
class LayerMean {
 public:
  void Add(const Layer& layer);
  Layer Mean() const;

 private:
  Layer sum_;
  int layers_ = 0;
};

}  // namespace shimmer::sim
