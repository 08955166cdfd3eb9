// A part of a resized picture, for what that part costs: nothing is read or computed of the rest.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::sim {

// Pixels `part` of what `samples` is when it is resized to `resized`, float32. An axis that shrinks takes the
// mean over what each new pixel covers, one that grows is bicubic (a = -0.75, the edge's pixel repeated
// beyond it): what cv::resize gives of the whole by INTER_AREA or INTER_CUBIC, but weighted and summed in
// double, so that a value is that of the exact sum within 1e-6 (of 1, or of the largest sample).
//
// samples: CV_8U (v / 255), CV_16U (v / 65535) or CV_32F (finite), of 1 or 3 channels. A pixel has the same
// bits whatever part it is asked in, and on every SIMD target. Throws std::invalid_argument for other types,
// sizes below 1, and a part that is empty or not within `resized`.
cv::Mat ResizedPart(const cv::Mat& samples, cv::Size resized, cv::Rect part);

}  // namespace shimmer::sim
