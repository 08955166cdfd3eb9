#include "restore/sharpen.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/levels.h"
#include "restore/tiles.h"

namespace shimmer::restore {
namespace {

constexpr int kBlock_px = 16;

// CV_32FC3 in [0, 1].
cv::Mat PictureOf(const cv::Mat& frame) {
  cv::Mat picture;
  frame.convertTo(picture, CV_32F, 1 / WhiteOf(frame.depth()));
  if (picture.channels() == 1) cv::merge(std::vector<cv::Mat>(3, picture), picture);
  if (frame.depth() == CV_32F) {
    cv::threshold(picture, picture, 1, 1, cv::THRESH_TRUNC);
    cv::threshold(picture, picture, 0, 0, cv::THRESH_TOZERO);
    cv::patchNaNs(picture, 0);  // a network would spread them over the tile
  }
  return picture;
}

// The frame with what sharpening adds to it.
cv::Mat WithChange(const cv::Mat& frame, const cv::Mat& change) {
  cv::Mat added, sum, result;
  if (frame.channels() == 1)
    cv::transform(change, added, cv::Matx13f::all(1.f / 3));
  else
    added = change;
  frame.convertTo(sum, CV_32F, 1 / WhiteOf(frame.depth()));
  sum += added;
  sum.convertTo(result, frame.depth(), WhiteOf(frame.depth()));
  return result;
}

// What rounding to whole samples makes of equal pictures: mean square difference, levels. (Two roundings,
// each with a variance of 1/12 of a step.)
double RoundingOf(int depth) {
  const double step = depth == CV_32F ? 0 : 255 / WhiteOf(depth);
  return step * step / 6;
}

// Whether no px is far from what it was, in all of a tile and in each of its blocks.
bool IsNear(const cv::Mat& now, const cv::Mat& before, double rounding, const SharpenParams& params) {
  const auto most_of = [&](double levels) { return levels > 0 ? levels * levels + rounding : 0; };
  cv::Mat squares, blocks;
  cv::subtract(now, before, squares);
  cv::multiply(squares, squares, squares, 255.0 * 255.0 / 3);  // of the three channels the mean
  cv::transform(squares, squares, cv::Matx13f::all(1));
  if (cv::mean(squares)[0] > most_of(params.kept_levels)) return false;
  const cv::Size count{std::max(1, now.cols / kBlock_px), std::max(1, now.rows / kBlock_px)};
  cv::resize(squares, blocks, count, 0, 0, cv::INTER_AREA);
  double most = 0;
  cv::minMaxLoc(blocks, nullptr, &most);
  return most <= most_of(params.kept_local_levels);
}

bool IsFlat(const cv::Mat& tile, double levels) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(tile, mean, deviation);
  return 255 * std::max({deviation[0], deviation[1], deviation[2]}) <= levels;
}

}  // namespace

void RequireTile(const TileSize& tile, cv::Size frame) {
  if (!tile.fixed || (frame.width >= tile.side_px && frame.height >= tile.side_px)) return;
  throw std::invalid_argument(
      "frames of " + SizeText(frame) + " px: are smaller than the " + SizeText({tile.side_px, tile.side_px}) +
      " px that the model takes: must be as large, or another model, or --no-sharpen");
}

Sharpener::Sharpener(std::shared_ptr<SharpeningNetwork> network, cv::Size frame, const SharpenParams& params)
    : network_(std::move(network)), size_(frame), params_(params) {
  const TileSize tile = network_->tile();
  RequireTile(tile, frame);
  for (const cv::Rect& place : Tiles(frame, tile.side_px, tile.overlap_px))
    tiles_.push_back({.place = place, .from = {}, .made = {}});
}

Sharpener::Renewal Sharpener::Renew(Tile& tile, const cv::Mat& picture, double rounding) const {
  const cv::Mat part = picture(tile.place);
  if (!tile.from.empty() && IsNear(part, tile.from, rounding, params_)) return Renewal::kKept;
  tile.from = part.clone();
  if (IsFlat(part, params_.flat_levels)) {
    tile.made = cv::Mat::zeros(part.size(), part.type());
    return Renewal::kFlat;
  }
  tile.made = network_->Sharpened(tile.from) - tile.from;
  return Renewal::kComputed;
}

cv::Mat Sharpener::Next(const cv::Mat& frame) {
  RequireFrame(frame, "frame");
  if (frame.size() != size_)
    throw std::invalid_argument("frame is of " + SizeText(frame.size()) + " px, must be of " +
                                SizeText(size_) + " px as those before");
  const cv::Mat picture = PictureOf(frame);
  std::vector<Renewal> renewals(tiles_.size());
  const auto renew = [&](size_t k) { renewals[k] = Renew(tiles_[k], picture, RoundingOf(frame.depth())); };
  // Whole tiles side by side wait for one another less than the parts of one do.
  if (network_->TakesManyAtOnce())
    tbb::parallel_for(size_t{0}, tiles_.size(), renew);
  else
    for (size_t k = 0; k < tiles_.size(); ++k) renew(k);
  const int64_t kept = std::ranges::count(renewals, Renewal::kKept);
  counts_.kept += kept;
  counts_.flat += std::ranges::count(renewals, Renewal::kFlat);
  counts_.computed += std::ranges::count(renewals, Renewal::kComputed);
  if (kept < std::ssize(tiles_)) {
    TileSum sum(size_, network_->tile().overlap_px);
    for (const Tile& tile : tiles_) sum.Add(tile.made, tile.place);
    change_ = sum.Whole();
  }
  return WithChange(frame, change_);
}

}  // namespace shimmer::restore
