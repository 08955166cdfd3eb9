// Restormers with random weights, for tests and benchmarks.
#pragma once

#include <opencv2/core.hpp>

#include "restore/model_card.h"

namespace shimmer::restore {

// The card of a network of this shape.
std::string CardText(const RestormerShape& shape);

// A file as ReadSafeTensors gives it, all tensors in it. Weights are such that values stay about 1
// throughout, and that the network changes an image by about 0.1.
SafeTensors RandomNetwork(const RestormerShape& shape, uint64_t seed);

// Multiplications and additions that an image of this size takes, of those in products and convolutions.
double MultiplyAdds(const RestormerShape& shape, cv::Size image);

double ParameterCount(const RestormerShape& shape);

cv::Mat RandomImage(cv::Size size, uint64_t seed);  // CV_32FC3 in [0, 1]

}  // namespace shimmer::restore
