// PNG files, written quickly: a 1024x1024 RGB photograph in 5 to 7 ms of one core, at the size of libpng's
// level 1 (docs/performance.md). Every row is filtered by Paeth and deflated by ISA-L.
//
// The bytes are a function of the samples alone: no time, no colour chunk, the same on any thread and on
// every x86-64 machine with SSE4.2 (ISA-L's kernels from SSE4.2 to AVX-512 were compared; those for older
// machines and for other architectures find other matches). What is promised everywhere is the samples that
// come back.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::dataset {

// A whole file. samples: CV_8U or CV_16U with 1 to 4 channels, which are grey, grey and alpha, RGB, RGBA;
// need not be continuous. Throws std::invalid_argument if empty, of another type, or over kMaxSide_px.
std::vector<uint8_t> WritePng(const cv::Mat& samples);

// No file of WritePng is larger than this, whatever the samples are: what deflating would make larger is
// stored as it is. One byte a row and 17 for every 65,535 more than the samples themselves, and 51.
// bits: 8 or 16. Throws std::invalid_argument for what WritePng doesn't write.
int64_t PngMostBytes(int width, int height, int channels, int bits);

}  // namespace shimmer::dataset
