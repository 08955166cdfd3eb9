// Px that become channels, and channels that become px.
#pragma once

#include "restore/panels.h"

namespace shimmer::restore {

// Px (2 x + i, 2 y + j) of channel c become px (x, y) of channel 4 c + 2 j + i. The size is even.
Panels Unshuffled(const Panels& image, Workspace& workspace);

// The other way, into the first channels of `to`, which is twice as large an axis and may have more.
void Shuffle(const Panels& image, Panels& to);

// Channels [0, from's) become those from first on of `to`, which is as large.
void CopyChannels(const Panels& from, int first, Panels& to);

// An image of three floats a px, CV_32FC3, whose px become channels: px (u x + i, u y + j) of channel c those
// (x, y) of channel u^2 c + u j + i. It is reflected beyond its right and bottom edge (without repeating the
// edge, as often as it takes) until its size is a multiple of multiple_px, which is one of u.
Panels UnshuffledImage(const cv::Mat& image, int u, int multiple_px, Workspace& workspace);

// image + what UnshuffledImage's inverse makes of change.
cv::Mat ChangedImage(const cv::Mat& image, const Panels& change, int u);

}  // namespace shimmer::restore
