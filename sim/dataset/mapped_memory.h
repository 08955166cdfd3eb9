// Memory of pictures that are kept for long. Only sim/dataset's own .cpp files include this.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::dataset {

// For a cv::Mat, before its create(): from 1 MiB on it is mapped from the system and goes back to it at once.
// Pictures of many sizes that come and go would leave holes in the heap, of a fifth of what is held.
cv::MatAllocator* MappedMemory();

}  // namespace shimmer::dataset
