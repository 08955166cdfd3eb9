#include "restore/border_fill.h"

#include <array>
#include <stdexcept>

#include "restore/translate.h"

namespace shimmer::restore {
namespace {

// What of `all` lies outside of `inner`: four stretches that do not meet, some empty.
std::array<cv::Rect, 4> Outside(cv::Rect all, cv::Rect inner) {
  if (inner.empty()) return {all};
  return {cv::Rect(all.x, all.y, all.width, inner.y - all.y),
          cv::Rect(all.x, inner.br().y, all.width, all.br().y - inner.br().y),
          cv::Rect(all.x, inner.y, inner.x - all.x, inner.height),
          cv::Rect(inner.br().x, inner.y, all.br().x - inner.br().x, inner.height)};
}

}  // namespace

BorderFill::BorderFill(int ahead) : ahead_(ahead) {
  if (ahead < 0)
    throw std::invalid_argument("BorderFill: ahead = " + std::to_string(ahead) + ", must be 0 or more");
}

std::optional<SteadyFrame> BorderFill::Next(const cv::Mat& frame, const FrameShift& shift) {
  if (past_.empty()) {
    past_.create(frame.size(), frame.type());
    past_at_ = cv::Mat(frame.size(), CV_32SC1, cv::Scalar(-1));
  }
  if (frame.size() != past_.size() || frame.type() != past_.type())
    throw std::invalid_argument("BorderFill: a frame of another size or type than the first");
  waiting_.push_back(
      {Translated(frame, shift.px), SeenArea(frame.size(), shift.px), shift.match == Match::kFound});
  if (static_cast<int>(waiting_.size()) <= ahead_) return {};
  return Filled();
}

std::optional<SteadyFrame> BorderFill::Rest() {
  if (waiting_.empty()) return {};
  return Filled();
}

SteadyFrame BorderFill::Filled() {
  const Waiting now = std::move(waiting_.front());
  waiting_.pop_front();
  SteadyFrame steady{now.frame, cv::Mat::zeros(now.frame.size(), CV_8UC1)};
  steady.own(now.own).setTo(255);
  for (const cv::Rect& border : Outside({{0, 0}, now.frame.size()}, now.own)) {
    if (border.empty()) continue;
    cv::Mat filled = cv::Mat::zeros(border.size(), CV_8UC1);
    int away = 0;
    for (const Waiting& later : waiting_) {
      ++away;
      const cv::Rect area = border & later.own;
      if (!later.lends || area.empty()) continue;
      cv::Mat already = filled(area - border.tl());
      const cv::Mat take = (already == 0) & (past_at_(area) < given_ - away);
      cv::Mat to = steady.frame(area);
      later.frame(area).copyTo(to, take);
      already.setTo(255, take);
    }
    const cv::Mat take = (filled == 0) & (past_at_(border) >= 0);
    cv::Mat to = steady.frame(border);
    past_(border).copyTo(to, take);
  }
  if (now.lends && !now.own.empty()) {
    cv::Mat seen = past_(now.own);
    now.frame(now.own).copyTo(seen);
    past_at_(now.own).setTo(given_);
  }
  ++given_;
  return steady;
}

}  // namespace shimmer::restore
