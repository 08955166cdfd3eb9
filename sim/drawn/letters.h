// Letters in single lines, smooth at any size: OpenCV's stroke fonts drawn large and averaged down. ASCII
// only; any other byte shows as a question mark. Sizes are heights of capitals, in px.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace shimmer::sim {

enum class Face { kSans, kSansBold, kSerif, kSerifBold };

double TextWidth(const std::string& text, Face face, double capital_px);

// Greedy lines of at most width_px; a wider word is broken anywhere, a line having one letter at least. Runs
// of spaces stay as they are within a line.
std::vector<std::string> WrapWords(const std::string& text, Face face, double capital_px, double width_px);

struct Lettering {
  cv::Mat_<float> coverage;  // share of each pixel that ink covers, [0, 1]
  cv::Point corner;          // pixel of the image that coverage(0, 0) belongs to
};

// origin: where the baseline begins, in px of the image, pixel centres at integers.
Lettering DrawLetters(const std::string& text, Face face, double capital_px, cv::Point2d origin);

// Inks the letters onto an image; parts outside of it are left out.
template <class Channel>
void Stamp(cv::Mat& image, const Lettering& letters, const cv::Vec<Channel, 3>& colour) {
  const cv::Rect covered = cv::Rect(letters.corner, letters.coverage.size()) & cv::Rect({}, image.size());
  for (int y = covered.y; y < covered.br().y; ++y) {
    for (int x = covered.x; x < covered.br().x; ++x) {
      auto& pixel = image.at<cv::Vec<Channel, 3>>(y, x);
      const float ink = letters.coverage(y - letters.corner.y, x - letters.corner.x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<Channel>(pixel[c] * (1 - ink) + colour[c] * ink);
    }
  }
}

}  // namespace shimmer::sim
