// What sharpening the frames of a video takes, and what its shortcuts cost.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace shimmer::bench {

// folder: pictures of one size and type, by name in order, as `unshimmer restore --stages` writes `blended`.
// model: empty is the one that unshimmer carries. Prints, and returns, for the frames but the first, on all
// threads: ms a frame, computed anew and with what can be kept; which share of tiles that was; and RMS in
// levels between both, and between tiles and the frame in one piece.
nlohmann::ordered_json SharpenFrames(const std::filesystem::path& folder, const std::filesystem::path& model);

}  // namespace shimmer::bench
