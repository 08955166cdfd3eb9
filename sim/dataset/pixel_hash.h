// A hash of what a picture shows, whatever the file around it: equal pixels, equal hash, on any machine.
//
// SHA-256, as 64 hex digits, of one line of text and the samples after it:
//
//   "WIDTH HEIGHT CHANNELS TYPE\n"       ASCII decimals; TYPE is uint8, uint16, float16 or float32
//   samples                              row by row, pixel by pixel, channel by channel, each little-endian
//
// Channels stand in the order of the picture: R, G, B; Y; dx, dy, sigma. In Python, of a decoded array
// a[y][x][c]:
//
//   hashlib.sha256(b"%d %d %d %s\n" % (w, h, c, a.dtype.name.encode()) +
//   a.astype(a.dtype.newbyteorder("<")).tobytes())
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {

// Of samples as ToSamples gives them (CV_8U, CV_16U, CV_16F, CV_32F). Throws std::invalid_argument for other
// types.
std::string PixelHashOfSamples(const cv::Mat& samples);

// Of a float32 picture as a file of this encoding holds it.
std::string PixelHash(const cv::Mat& image, Encoding encoding);

}  // namespace shimmer::dataset
