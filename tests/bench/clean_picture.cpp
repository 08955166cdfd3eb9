#include "tests/bench/clean_picture.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sim/crop.h"
#include "sim/drawn/drawn.h"

namespace shimmer::bench {
namespace {

constexpr int kHaloPx = 256;

}  // namespace

CleanPicture::CleanPicture(const std::string& file, cv::Size size) {
  if (file.empty()) {
    // Bricks: fine grain everywhere, so that no shortcut for constant regions flatters the time.
    sim::DrawScene(sim::DrawnScene::kBricks, size, kHaloPx, 1, 0).convertTo(picture_, CV_8U, 255);
    return;
  }
  cv::Mat photograph = cv::imread(file, cv::IMREAD_COLOR);
  if (photograph.empty()) throw std::runtime_error(file + " is not a picture that can be read");
  cv::cvtColor(photograph, photograph, cv::COLOR_BGR2RGB);
  picture_ = sim::CropWithHalo(photograph, {{}, size}, kHaloPx);
}

cv::Mat CleanPicture::Bytes(int halo_px) const {
  if (halo_px > kHaloPx)
    throw std::invalid_argument("halo of " + std::to_string(halo_px) + " px, must be at most " +
                                std::to_string(kHaloPx));
  const int off_px = kHaloPx - halo_px;
  return picture_(cv::Rect(off_px, off_px, picture_.cols - 2 * off_px, picture_.rows - 2 * off_px)).clone();
}

cv::Mat CleanPicture::Floats(int halo_px) const {
  cv::Mat floats;
  Bytes(halo_px).convertTo(floats, CV_32F, 1 / 255.0);
  return floats;
}

}  // namespace shimmer::bench
