#include "restore/levels.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace shimmer::restore {
namespace {

template <class Sample>
cv::Mat LevelsOf(const cv::Mat& frame, cv::Range rows) {
  const double white = WhiteOf(frame.depth());
  const int samples = frame.cols * frame.channels();
  cv::Mat levels(rows.size(), frame.cols, CV_64FC(frame.channels()));
  for (int y = rows.start; y < rows.end; ++y) {
    const auto* from = frame.ptr<Sample>(y);
    auto* to = levels.ptr<double>(y - rows.start);
    double sum = 0;  // not finite if one of them is not
    for (int i = 0; i < samples; ++i) sum += to[i] = static_cast<double>(from[i]) * 255 / white;
    if (!std::isfinite(sum))
      throw std::invalid_argument("frame: a sample of row " + std::to_string(y) + " is not finite");
  }
  return levels;
}

}  // namespace

std::string SizeText(cv::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

double WhiteOf(int depth) { return depth == CV_8U ? 255 : depth == CV_16U ? 65535 : 1; }

void RequireFrame(const cv::Mat& frame, const char* name) {
  const int depth = frame.depth(), channels = frame.channels();
  if (!frame.empty() && frame.dims == 2 && (depth == CV_8U || depth == CV_16U || depth == CV_32F) &&
      (channels == 1 || channels == 3))
    return;
  throw std::invalid_argument(std::string(name) + ": is " +
                              (frame.empty() ? "empty" : cv::typeToString(frame.type())) +
                              ", must be CV_8U, CV_16U or CV_32F with 1 or 3 channels");
}

int RequireFramePair(const cv::Mat& a, const cv::Mat& b) {
  RequireFrame(a, "a");
  RequireFrame(b, "b");
  if (a.size() != b.size())
    throw std::invalid_argument("a: is " + SizeText(a.size()) + " px, must be " + SizeText(b.size()) +
                                " as b");
  return std::max(a.channels(), b.channels());
}

cv::Mat Levels(const cv::Mat& frame, cv::Range rows, int channels) {
  cv::Mat levels = frame.depth() == CV_8U    ? LevelsOf<uint8_t>(frame, rows)
                   : frame.depth() == CV_16U ? LevelsOf<uint16_t>(frame, rows)
                                             : LevelsOf<float>(frame, rows);
  if (levels.channels() < channels) cv::merge(std::vector(3, levels), levels);
  return levels;
}

cv::Mat LumaLevels(const cv::Mat& frame, cv::Range rows, int channels) {
  cv::Mat levels = Levels(frame, rows, channels);
  if (levels.channels() == 1) return levels;
  cv::Mat luma(levels.size(), CV_64FC1);
  for (int y = 0; y < levels.rows; ++y) {
    const auto* rgb = levels.ptr<cv::Vec3d>(y);
    auto* to = luma.ptr<double>(y);
    for (int x = 0; x < levels.cols; ++x)
      to[x] = 16 + (65.481 * rgb[x][0] + 128.553 * rgb[x][1] + 24.966 * rgb[x][2]) / 255;
  }
  return luma;
}

cv::Mat MostOfChannels(const cv::Mat& frame) {
  if (frame.channels() == 1) return frame;
  std::vector<cv::Mat> channels;
  cv::split(frame, channels);
  cv::Mat most = channels[0];
  for (size_t c = 1; c < channels.size(); ++c) most = cv::max(most, channels[c]);
  return most;
}

}  // namespace shimmer::restore
