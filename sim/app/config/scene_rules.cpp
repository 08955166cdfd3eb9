// Rules between the keys of scenes that move: camera, objects, masks and their truth.
#include <algorithm>
#include <string>

#include "sim/app/config/distribution.h"
#include "sim/app/config/keys.h"
#include "sim/app/config/rules.h"
#include "sim/dataset/compression.h"
#include "sim/motion.h"
#include "sim/size_text.h"

namespace shimmer::app {
namespace {

const Json& ValueOf(const Json& resolved, const Key& key) {
  return resolved.at(Json::json_pointer(key.pointer));
}

// Layouts that keep single frames of a clip.
bool KeepsSingleFrames(const Config& fixed) {
  return fixed.output.layout == LayoutKind::kPairs || fixed.output.layout == LayoutKind::kRestormer;
}

void CheckCamera(const Json& resolved, const Config& fixed) {
  const sim::CameraParams& camera = DefaultConfig().camera;
  const auto shifts = std::ssize(fixed.camera.shifts);
  if (MayBe(ValueOf(resolved, KeyOf(camera.shake)), "list") && shifts < fixed.frames)
    throw ConfigError(KeyOf(camera.shifts).pointer, "has " + std::to_string(shifts) +
                                                        " shifts, must have one for each of the " +
                                                        std::to_string(fixed.frames) + " frames where " +
                                                        KeyOf(camera.shake).path + " is list");
}

// Whether nothing in a section is drawn.
bool IsFixed(const Json& section) {
  return std::ranges::none_of(section, [](const Json& value) { return value.is_object(); });
}

// A path that is the same in every clip; others fail with their clip.
void CheckPath(const Json& object, const Json& resolved, const Config& fixed, size_t i) {
  if (!IsFixed(object.at("motion")) || resolved.at("size").is_object()) return;
  try {
    sim::Motion(fixed.objects[i].motion, fixed.size, fixed.frames);
  } catch (const std::invalid_argument& error) {
    throw ConfigError("/objects/" + std::to_string(i) + "/motion", error.what());
  }
}

void CheckObjects(const Json& resolved, const Config& fixed) {
  for (size_t i = 0; i < fixed.objects.size(); ++i) {
    const ObjectParams& object = fixed.objects[i];
    const bool video = !object.video.empty() || !object.sequence.empty();
    if (video == object.masks.empty())
      throw ConfigError("/objects/" + std::to_string(i) + "/masks",
                        video ? "is empty, must say where in the video the object is"
                              : "has no meaning without video or sequence");
    CheckPath(resolved.at("objects")[i], resolved, fixed, i);
  }
}

void CheckTruth(const Config& fixed) {
  const bool video = !fixed.source.video.empty() || !fixed.source.sequence.empty();
  if (!fixed.source.masks.empty() && !video)
    throw ConfigError(KeyOf(DefaultConfig().source.masks).pointer,
                      "has no meaning without source.video or source.sequence");
  const std::vector<std::string>& truth = fixed.output.truth;
  for (size_t i = 0; i < truth.size(); ++i) {
    const std::string pointer = PointerUnder(KeyOf(DefaultConfig().output.truth).pointer, i);
    if (truth[i] == "flow" && video)
      throw ConfigError(pointer,
                        "is \"flow\", but how things move in a video is not known: must be left out, or the "
                        "source be images or drawn");
    if ((truth[i] == "flow" || truth[i] == "shake") && KeepsSingleFrames(fixed))
      throw ConfigError(pointer, "is \"" + truth[i] +
                                     "\", which goes from frame to frame: must be left out where "
                                     "output.layout is pairs or restormer, which keep single ones");
  }
}

// A stream is made of all frames, and has the sides that its encoder knows.
void CheckCompression(const Json& resolved, const Config& fixed) {
  const Key& key = KeyOf(DefaultConfig().sensor.compression);
  if (!MayBe(ValueOf(resolved, key), "h264")) return;
  const Key& size = KeyOf(DefaultConfig().size);
  if (const cv::Size largest = LargestSizeOf(ValueOf(resolved, size));
      std::max(largest.width, largest.height) > dataset::kMaxH264Side_px)
    throw ConfigError(size.pointer, "is up to " + sim::SizeText(largest) + ", must be at most " +
                                        std::to_string(dataset::kMaxH264Side_px) + " px each way where " +
                                        key.path + " is h264");
  if (KeepsSingleFrames(fixed) && fixed.output.frames_per_clip != fixed.frames)
    throw ConfigError(key.pointer,
                      "is h264, which takes all frames of a clip: must be none or jpeg where "
                      "output.frames_per_clip keeps " +
                          std::to_string(fixed.output.frames_per_clip) + " of " +
                          std::to_string(fixed.frames));
}

}  // namespace

void CheckSceneRules(const Json& resolved, const Config& fixed) {
  CheckCamera(resolved, fixed);
  CheckObjects(resolved, fixed);
  CheckTruth(fixed);
  CheckCompression(resolved, fixed);
}

}  // namespace shimmer::app
