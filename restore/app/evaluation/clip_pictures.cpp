#include "restore/app/evaluation/clip_pictures.h"

#include <opencv2/imgproc.hpp>

#include "restore/app/evaluation/pictures.h"
#include "restore/levels.h"
#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"

namespace shimmer::restore::app {
namespace {

constexpr int kJpegQuality = 88;
const cv::Scalar kTrueColour(40, 220, 60), kFoundColour(235, 50, 40);

cv::Mat Bytes(const cv::Mat& frame) {
  cv::Mat bytes;
  frame.convertTo(bytes, CV_8U, 255 / WhiteOf(frame.depth()));
  if (bytes.channels() == 1) cv::cvtColor(bytes, bytes, cv::COLOR_GRAY2RGB);
  return bytes;
}

// No wider than the report wants it; rows over time keep their height.
cv::Mat Narrowed(const cv::Mat& picture, bool keeps_height) {
  if (picture.cols <= kPictureWidth_px) return picture;
  const int rows = keeps_height ? picture.rows : picture.rows * kPictureWidth_px / picture.cols;
  cv::Mat narrow;
  cv::resize(picture, narrow, {kPictureWidth_px, std::max(rows, 1)}, 0, 0, cv::INTER_AREA);
  return narrow;
}

void Outline(const cv::Mat& mask, const cv::Scalar& colour, cv::Mat& picture) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture, outlines, -1, colour, std::max(1, picture.cols / 500));
}

}  // namespace

ClipPictures::ClipPictures(TrueClip& clip, std::filesystem::path folder)
    : clip_(clip),
      folder_(std::move(folder)),
      input_rows_(clip.facts().size.height / 2),
      result_rows_(input_rows_),
      truth_rows_(input_rows_) {}

void ClipPictures::Add(const FrameOnWay& frame, const TrueFrame& truth) {
  const cv::Mat input = clip_.Turb(frame.index);
  input_rows_.Add(input);
  result_rows_.Add(frame.frame);
  if (truth.clean) truth_rows_.Add(*truth.clean);
  if (frame.index != clip_.facts().frames / 2) return;
  pictures_[kInputPicture] = Bytes(input);
  pictures_[kResultPicture] = Bytes(frame.frame);
  if (truth.clean) pictures_[kTruthPicture] = Bytes(*truth.clean);
  cv::Mat marked = Bytes(frame.frame);
  const bool is_true = truth.moving && cv::countNonZero(*truth.moving) > 0;
  const bool is_found =
      !frame.mask.empty() && frame.mask.size() == marked.size() && cv::countNonZero(frame.mask) > 0;
  if (is_true) Outline(*truth.moving, kTrueColour, marked);
  if (is_found) Outline(frame.mask >= 128, kFoundColour, marked);
  if (is_true || is_found) pictures_[kMaskPicture] = marked;
}

void ClipPictures::Finish() {
  dataset::MakeFolders(folder_);
  for (const auto& [name, picture] : pictures_)
    dataset::WriteFileAtomically(folder_ / name, dataset::EncodeJpeg(Narrowed(picture, false), kJpegQuality));
  const std::pair<const char*, const TimeSlice*> slices[] = {
      {kInputRows, &input_rows_}, {kResultRows, &result_rows_}, {kTruthRows, &truth_rows_}};
  for (const auto& [name, slice] : slices)
    if (!slice->picture().empty())
      dataset::WriteFileAtomically(folder_ / name,
                                   dataset::EncodePng(Narrowed(Bytes(slice->picture()), true), 8));
}

}  // namespace shimmer::restore::app
