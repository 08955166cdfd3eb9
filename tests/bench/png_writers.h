// PNG writers side by side: ours and those that people use, each at its quickest usual setting.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::bench {

struct PngPeer {
  const char* name;
  bool blue_first;  // wants BGR where the others want RGB
  std::vector<uint8_t> (*write)(const cv::Mat& samples);
};

// Ours first. All take 8 and 16 bits, grey and colour; throw std::runtime_error where they fail.
const std::vector<PngPeer>& PngPeers();

}  // namespace shimmer::bench
