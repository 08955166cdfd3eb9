#include "tests/bench/png_writers.h"

#include <png.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "sim/dataset/image_io.h"
#include "sim/dataset/png_write.h"

namespace shimmer::bench {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes ByOpenImageIo(const cv::Mat& samples) {
  return dataset::EncodePng(samples, samples.depth() == CV_8U ? 8 : 16, dataset::PngWriter::kOpenImageIo);
}

Bytes ByOpenCv(const cv::Mat& samples) {
  Bytes file;
  if (!cv::imencode(".png", samples, file, {cv::IMWRITE_PNG_COMPRESSION, 1}))
    throw std::runtime_error("OpenCV writes no PNG");
  return file;
}

// Level 1 and, as libpng does if not told otherwise, all filters in turn for each row.
Bytes ByLibpng(const cv::Mat& samples) {
  Bytes file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    throw std::runtime_error("libpng writes no PNG");
  }
  const auto append = [](png_structp to, png_bytep bytes, size_t count) {
    auto& all = *static_cast<Bytes*>(png_get_io_ptr(to));
    all.insert(all.end(), bytes, bytes + count);
  };
  png_set_write_fn(png, &file, append, [](png_structp) {});
  png_set_compression_level(png, 1);
  png_set_IHDR(png, info, samples.cols, samples.rows, samples.depth() == CV_8U ? 8 : 16,
               samples.channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (samples.depth() == CV_16U) png_set_swap(png);
  for (int y = 0; y < samples.rows; ++y) png_write_row(png, samples.ptr(y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace

const std::vector<PngPeer>& PngPeers() {
  static const std::vector<PngPeer> peers = {{"shimmer", false, dataset::WritePng},
                                             {"openimageio", false, ByOpenImageIo},
                                             {"opencv", true, ByOpenCv},
                                             {"libpng", false, ByLibpng}};
  return peers;
}

}  // namespace shimmer::bench
