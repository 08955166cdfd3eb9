// What an evaluation measures of a sequence: each by one name in results.json, results.csv and the report.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace shimmer::restore::app {

using Value = std::optional<double>;  // absent where it is not defined

// Of frames against the true ones, as the mean over frames: on all px that the camera saw in a frame, and on
// some of them. The foreground is where the true mask is at least half, the background what else there is,
// the box the smallest rectangle around the foreground.
enum class Measure {
  kPsnr,
  kSsim,
  kPsnrBackground,
  kSsimBackground,
  kPsnrForeground,
  kSsimForeground,
  kPsnrBox,
  kSsimBox,
  kLineDeviation,  // of the frames alone (line_deviation.h, stability.h)
  kStability,
  kShiftMean,  // error of the shifts that stabilising found, over the frames
  kShiftP95,
  kShiftMost,
  kIou,  // of the masks that segmenting found (mask_scores.h)
  kPrecision,
  kRecall,
  kFoundTilt,  // along an axis, RMS over the clip, as the frames let it be estimated
  kTime,       // in the stage, a frame
};
inline constexpr size_t kMeasureCount = static_cast<size_t>(Measure::kTime) + 1;

enum class Better { kMore, kLess, kNeither };

struct MeasureText {
  const char *name, *label, *unit;  // unit: "" where there is none
  int decimals;
  Better better;
};
inline constexpr std::array<MeasureText, kMeasureCount> kMeasureTexts = {{
    {"psnr_db", "PSNR", "dB", 2, Better::kMore},
    {"ssim", "SSIM", "", 3, Better::kMore},
    {"psnr_background_db", "PSNR, background", "dB", 2, Better::kMore},
    {"ssim_background", "SSIM, background", "", 3, Better::kMore},
    {"psnr_foreground_db", "PSNR, foreground", "dB", 2, Better::kMore},
    {"ssim_foreground", "SSIM, foreground", "", 3, Better::kMore},
    {"psnr_box_db", "PSNR, foreground's box", "dB", 2, Better::kMore},
    {"ssim_box", "SSIM, foreground's box", "", 3, Better::kMore},
    {"line_deviation_deg", "line deviation", "deg", 2, Better::kLess},
    {"stability_levels", "stability", "levels", 2, Better::kLess},
    {"shift_error_mean_px", "shift error, mean", "px", 3, Better::kLess},
    {"shift_error_p95_px", "shift error, 95th percentile", "px", 3, Better::kLess},
    {"shift_error_max_px", "shift error, max", "px", 3, Better::kLess},
    {"iou", "mask IoU", "", 3, Better::kMore},
    {"precision", "mask precision", "", 3, Better::kMore},
    {"recall", "mask recall", "", 3, Better::kMore},
    {"found_tilt_rms_px", "tilt found", "px", 2, Better::kNeither},
    {"ms_per_frame", "time", "ms a frame", 1, Better::kLess},
}};

inline constexpr const MeasureText& TextOf(Measure measure) {
  return kMeasureTexts[static_cast<size_t>(measure)];
}

class Measures {
 public:
  Value& operator[](Measure measure) { return values_[static_cast<size_t>(measure)]; }
  Value operator[](Measure measure) const { return values_[static_cast<size_t>(measure)]; }
  friend bool operator==(const Measures&, const Measures&) = default;

 private:
  std::array<Value, kMeasureCount> values_;
};

}  // namespace shimmer::restore::app
