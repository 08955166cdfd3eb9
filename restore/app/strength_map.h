// How strong the turbulence of a video is, over its picture: as numbers, and to be looked at.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/plan.h"
#include "restore/turbulence_strength.h"

namespace shimmer::restore::app {

// The number of the video, the map by its rows, the optics; what is not known is null. As docs/restoration.md
// describes it.
nlohmann::ordered_json StrengthJson(const TurbulenceStrength& strength, const std::optional<Optics>& optics,
                                    const RestorePlan& plan);

// A px a square of the map: tilt_variance_px2, and cn2 where there are optics. NaN where texture is too
// little.
std::vector<uint8_t> StrengthExr(const TurbulenceStrength& strength, const std::optional<Optics>& optics);

// The map as colours from dark (none) to light (what all but a fiftieth of the squares are below, and more),
// grey where texture is too little, and beside it what they stand for. CV_8UC3 RGB.
cv::Mat StrengthPicture(const TurbulenceStrength& strength, const std::optional<Optics>& optics);

}  // namespace shimmer::restore::app
