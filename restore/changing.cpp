#include "restore/changing.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace shimmer::restore {
namespace {

constexpr double kLeastSaved = 0.05;  // of the frame
constexpr double kOneColour = 0.8;    // share of a bar's px that are as those beside and above them
constexpr int kLeastSide_px = 16;     // of the picture: stabilising needs it

bool SameBits(const uchar* a, const uchar* b, size_t bytes) { return std::memcmp(a, b, bytes) == 0; }

// The box, and all px beyond it that differ. Empty at first.
cv::Rect Grown(cv::Rect box, const cv::Mat& first, const cv::Mat& frame) {
  const auto px_bytes = static_cast<int>(frame.elemSize());
  const int row_bytes = frame.cols * px_bytes;
  const auto same_row = [&](int y) { return SameBits(first.ptr(y), frame.ptr(y), row_bytes); };
  int top = 0, bottom = frame.rows, left = box.empty() ? frame.cols : box.x, right = box.br().x;
  while (top < (box.empty() ? frame.rows : box.y) && same_row(top)) ++top;
  if (top == frame.rows) return box;
  while (bottom > std::max(top, box.br().y) && same_row(bottom - 1)) --bottom;
  for (int y = top; y < bottom; ++y) {
    const uchar *a = first.ptr(y), *b = frame.ptr(y);
    const auto before = std::mismatch(a, a + left * px_bytes, b).first - a;
    left = std::min(left, static_cast<int>(before) / px_bytes);
    int end = row_bytes;
    while (end > right * px_bytes && a[end - 1] == b[end - 1]) --end;
    right = std::max(right, (end + px_bytes - 1) / px_bytes);
  }
  return {left, top, right - left, bottom - top};
}

bool IsOfOneColour(const cv::Mat& bar) {
  const size_t px_bytes = bar.elemSize();
  int64_t same = 0, all = 0;
  for (int y = 0; y < bar.rows; ++y)
    for (int x = 0; x < bar.cols; ++x) {
      const uchar* px = bar.ptr(y, x);
      same += (x == 0 || SameBits(px, px - px_bytes, px_bytes)) &&
              (y == 0 || SameBits(px, bar.ptr(y - 1, x), px_bytes));
      ++all;
    }
  return static_cast<double>(same) >= kOneColour * static_cast<double>(all);
}

// On sides where what lies beyond the box is no bar, to the frame's edge; and to at least kLeastSide_px.
cv::Rect WithoutBars(cv::Rect box, const cv::Mat& first) {
  int left = box.x, top = box.y, right = box.br().x, bottom = box.br().y;
  if (!IsOfOneColour(first.rowRange(0, top))) top = 0;
  if (!IsOfOneColour(first.rowRange(bottom, first.rows))) bottom = first.rows;
  if (!IsOfOneColour(first(cv::Range(top, bottom), cv::Range(0, left)))) left = 0;
  if (!IsOfOneColour(first(cv::Range(top, bottom), cv::Range(right, first.cols)))) right = first.cols;
  const auto widen = [](int& from, int& to, int end) {
    to = std::min(end, std::max(to, from + kLeastSide_px));
    from = std::max(0, std::min(from, to - kLeastSide_px));
  };
  widen(left, right, first.cols);
  widen(top, bottom, first.rows);
  return {left, top, right - left, bottom - top};
}

}  // namespace

Changing FindChanging(Frames& video, const std::function<void()>& step) {
  const cv::Mat first = video.Read(0).clone();
  step();
  const cv::Rect all({}, first.size());
  const auto saves = [&](cv::Rect box) { return box.area() <= (1 - kLeastSaved) * all.area(); };
  cv::Rect box;
  for (int64_t k = 1; k < video.count() && saves(box); ++k) {
    const cv::Mat frame = video.Read(k);
    if (frame.size() != first.size() || frame.type() != first.type()) return {all, {}};  // LookAt says so
    box = Grown(box, first, frame);
    step();
  }
  if (box.empty() || !saves(box)) return {all, {}};
  box = WithoutBars(box, first);
  return saves(box) ? Changing{box, first} : Changing{all, {}};
}

cv::Mat Inside::Read(int64_t frame) {
  const cv::Mat whole = video_.Read(frame);
  if (area_.size() == whole.size()) return whole;
  return whole(area_);
}

}  // namespace shimmer::restore
