#include "restore/look.h"

#include <cstring>

namespace shimmer::restore {
namespace {

template <class Sample>
bool ChannelsAreEqual(const cv::Mat& rgb) {
  for (int y = 0; y < rgb.rows; ++y) {
    const auto* row = rgb.ptr<cv::Vec<Sample, 3>>(y);
    for (int x = 0; x < rgb.cols; ++x)
      if (row[x][0] != row[x][1] || row[x][0] != row[x][2]) return false;  // in colour: at the first px or so
  }
  return true;
}

bool IsGrey(const cv::Mat& frame) {
  if (frame.channels() == 1) return true;
  if (frame.depth() == CV_8U) return ChannelsAreEqual<uint8_t>(frame);
  if (frame.depth() == CV_16U) return ChannelsAreEqual<uint16_t>(frame);
  return ChannelsAreEqual<float>(frame);
}

bool SameBits(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  const size_t row_bytes = static_cast<size_t>(a.cols) * a.elemSize();
  for (int y = 0; y < a.rows; ++y)
    if (std::memcmp(a.ptr(y), b.ptr(y), row_bytes) != 0) return false;
  return true;
}

}  // namespace

VideoFacts LookAt(Frames& video, const StabiliseParams& params, const std::function<void()>& step,
                  const Changing& changing) {
  VideoFacts facts{.frames = video.count(),
                   .grey = changing.first.empty() || IsGrey(changing.first),
                   .alike = true,
                   .changing = changing};
  Stabiliser stabiliser(params);
  const auto take = [&](std::vector<FrameShift> known) {
    facts.shifts.insert(facts.shifts.end(), known.begin(), known.end());
  };
  cv::Mat first;
  for (int64_t k = 0; k < facts.frames; ++k) {
    const cv::Mat frame = video.Read(k);
    if (k == 0) facts.size = frame.size(), facts.type = frame.type(), first = frame.clone();
    facts.grey = facts.grey && IsGrey(frame);
    facts.alike = facts.alike && SameBits(first, frame);
    take(stabiliser.Next(frame));
    step();
  }
  take(stabiliser.Rest());
  return facts;
}

}  // namespace shimmer::restore
