// Pictures of a clip that a report shows: REPORT/pictures/CLIP/NAME.jpg, of its middle frame and of one row
// over time; written with the full pipeline's rows, each no more than kPictureWidth_px wide.
#pragma once

#include <filesystem>
#include <string>

namespace shimmer::restore::app {

inline constexpr const char* kPicturesFolder = "pictures";
inline constexpr int kPictureWidth_px = 960;

// REPORT/pictures/CLIP: a clip's name as one folder, also of a real video, whose name is a path
// ("videos/door.mp4": "videos_door.mp4").
std::filesystem::path PicturesOf(const std::filesystem::path& report, const std::string& clip);

// Of a real video there is no truth.
inline constexpr const char* kInputPicture = "input.jpg";    // as turbulent as it was
inline constexpr const char* kResultPicture = "result.jpg";  // restored
inline constexpr const char* kTruthPicture = "truth.jpg";
// The restored frame, with the outline of the true mask in green and of what was found in red; only of clips
// in which one of them is not empty.
inline constexpr const char* kMaskPicture = "mask.jpg";
// The middle row of the frames over time, downwards: each row of the picture is a frame.
inline constexpr const char* kInputRows = "rows_input.png";
inline constexpr const char* kResultRows = "rows_result.png";
inline constexpr const char* kTruthRows = "rows_truth.png";

}  // namespace shimmer::restore::app
