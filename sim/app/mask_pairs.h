// Which masks belong to which videos.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace shimmer::app {

// For each item the index of its mask, by the parts of their names in which items differ from one another and
// masks do: bear.mp4 and bear-2.mp4 go with bear_mask.mp4 and bear-2_mask.mp4. One item goes with one mask
// whatever their names. Throws std::invalid_argument that says what is without its like.
std::vector<size_t> PairMasks(std::span<const std::string> items, std::span<const std::string> masks);

}  // namespace shimmer::app
