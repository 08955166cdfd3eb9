// Arrays of numpy's own format, .npy (NEP 1): fields that others wrote.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace shimmer::dataset {

// An array of two dimensions, rows x columns, or three, rows x columns x channels (1 to 4): CV_32FC(n) or
// CV_64FC(n) as the file's own numbers, little-endian float32 or float64, in C's order or Fortran's. Throws std::runtime_error
// "PATH: what is wrong" for others, and for one that is cut off.
cv::Mat ReadNpy(const std::filesystem::path& path);

}  // namespace shimmer::dataset
