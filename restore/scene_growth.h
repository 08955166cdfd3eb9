// The still scene continued into places where something is seen to move in every frame.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "restore/scene_sample.h"

namespace shimmer::restore {

// Around a thing that moves slowly, the optical flow sees its surroundings move along, and no frame is left
// to show them. But they look alike in all frames, and like the scene that they hang together with; the thing
// does not. So from what is known outwards, px by px: a px that in most samples (4 of 5 of its own, and 2 at
// least) lies within the range of its known neighbours, plus or minus the tolerance, becomes known, as the
// median of those samples. What ends at an edge stays unknown. picture: CV_32FC1 or 3, in levels; known:
// CV_8UC1, 255 or 0; both are continued. tolerance: in levels.
void GrowScene(cv::Mat& picture, cv::Mat& known, const std::vector<SceneSample>& samples, double tolerance);

}  // namespace shimmer::restore
