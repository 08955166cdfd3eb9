// How strong the turbulence of a video is, from its frames alone: by how far static px move.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace shimmer::restore {

// Where Cn2 and the tilt that it causes are proportional to one another: the variance of the angle of arrival
// along one axis is P D^(-1/3) Int Cn2 (z/L)^(5/3) dz for light from a point, and P D^(-1/3) Int Cn2 dz for
// parallel light. P says what is taken for a tilt.
enum class Tilt {
  kEdge,   // 2.914: the angle between the wave at two opposite edges of the aperture
  kGrad,   // 2.838: the mean gradient over it (G-tilt); what a centroid follows
  kPlane,  // 3.041: the plane that fits it best (Z-tilt); what the warp of a whole picture is nearest to
};
double TiltConstant(Tilt tilt);

struct Optics {
  double pixel_rad = 0;   // field of view of one px (PFOV): the px's pitch / focal length
  double aperture_m = 0;  // D
  double distance_m = 0;  // L
  Tilt tilt = Tilt::kPlane;
  bool point_source = true;  // a scene at a distance L: 3/8 of what the same air does to parallel light
};

// Cn2 in m^(-2/3), taken as the same along the path, from the variance of the tilt along one axis:
//   PFOV^2 D^(1/3) / (L P) * variance,  P times 3/8 for a point source.
// The equation of the paper and of Zamek & Yitzhaky 2006, with sigma(V)^2 / Grad(V)^2 for the variance: the
// paper prints the gradient unsquared, which has not the dimension of one. Rytov's theory: doubtful above
// some 1e-14 over 1 km. Throws std::invalid_argument for optics that are not above 0.
double Cn2Of(double tilt_variance_px2, const Optics& optics);

struct TurbulenceStrength {
  // Proportional to Cn2: variance of the tilt along an axis, px^2, the mean over texture. 0 where there is
  // none, or one frame. What is common to a whole frame is missing where a video was stabilised.
  double tilt_variance_px2 = 0;
  cv::Mat map;              // CV_32FC1: the same by squares of square_px; NaN where texture is too little
  int square_px = 0;        // side of a square of the map, px of a frame; the last ones may be cut
  double texture = 0;       // share of the squares that have enough
  double noise_levels = 0;  // standard deviation of what changes where nothing is to be seen, reduced frames
};

// Frames one after the other, in the memory of five reduced frames in double, however many there are.
//
// sigma^2 is the variance over time of a px's grey value, less that of the px with the least texture: noise.
// Grad^2 is of two kinds, since the mean of frames that move is softer than they are: the mean of the frames'
// squared gradients, G, and that of the mean, g. For a wave of any length and tilts of any size sigma^2 / v
// is (G - g) / (ln G - ln g), which is used; for small tilts it is what the equation says. Sums over
// squares, so that texture weighs as much as it tells; squares of more than 6 times the median are no air.
//
// Within 10 % of the root mean square up to 3 px where the air's waves are 20 px or longer. Where tilts are
// as large as the waves are short, smoothing hides some of it: clips of Shimmer of 0.49, 0.98, 1.97 and 4.9
// px are found to have 0.46 to 0.50, 0.86 to 0.94, 1.5 to 1.7 and 2.8 to 3.1.
class StrengthEstimate {
 public:
  // frame: CV_8U, CV_16U or CV_32F of 1 or 3 channels, 16x16 px or more, of the size and type of the first.
  // moving: CV_8UC1 of that size: 0 where the frame shows the static scene, and counts. Empty: everywhere.
  // Throws std::invalid_argument for others.
  void Add(const cv::Mat& frame, const cv::Mat& moving = {});

  TurbulenceStrength Result() const;

 private:
  cv::Size size_;
  int type_ = 0;
  cv::Mat count_, mean_, deviation_, gradient_;  // CV_64FC1, by px of the reduced frame
};

}  // namespace shimmer::restore
