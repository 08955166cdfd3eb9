// Letters as a cut-out, for objects that are words.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace shimmer::sim {

// CV_32FC4, colour times alpha, trimmed to the letters and a px around them; capitals are 64 px high. What is
// not ASCII shows as '?'. Throws std::invalid_argument where nothing would be seen.
cv::Mat TextCutout(const std::string& text, const cv::Vec3f& colour);

}  // namespace shimmer::sim
