#include "sim/dataset/layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace shimmer::dataset {
namespace {

std::string Padded(int64_t number, size_t digits) {
  std::string text = std::to_string(number);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  return text;
}

const char* FolderOf(FrameKind kind, LayoutKind layout) {
  switch (kind) {
    case FrameKind::kTurb:
      return "turb";
    case FrameKind::kClean:
      return layout == LayoutKind::kPairs ? "noturb" : "clean";
    case FrameKind::kTruth:
      return "truth";
  }
  throw std::invalid_argument("unknown kind of frame");
}

}  // namespace

void Layout::Validate() const {
  if (kind == LayoutKind::kSequence) return;
  if (!IsPlainFolderName(name))
    throw std::invalid_argument("name = \"" + name + "\", must be a plain name of a folder");
  if (!(test_fraction >= 0 && test_fraction <= 1))
    throw std::invalid_argument("test_fraction = " + std::to_string(test_fraction) + ", must be in [0, 1]");
  if (frames_per_clip < 1) throw std::invalid_argument("frames_per_clip must be at least 1");
  if (digits < 6 || digits > 18) throw std::invalid_argument("digits must be in [6, 18]");
}

std::string Layout::Path(FrameKind frame_kind, int64_t clip, int64_t frame) const {
  const std::string extension = frame_kind == FrameKind::kTruth ? "exr" : Extension(format);
  const std::string folder = FolderOf(frame_kind, kind);
  if (kind == LayoutKind::kSequence)
    return ClipFolder(clip) + "/" + folder + "/" + Padded(frame, 4) + "." + extension;
  const std::string half = IsTestClip(clip, test_fraction) ? "test" : "train";
  return name + "/" + half + "/" + folder + "/" + Padded(clip * frames_per_clip + frame, digits) + "." +
         extension;
}

std::string Layout::ClipFolder(int64_t clip) const {
  return kind == LayoutKind::kSequence ? "clips/" + Padded(clip, 6) : "";
}

bool IsPlainFolderName(const std::string& name) {
  const auto bad = [](unsigned char c) { return c == '/' || c == '\\' || c < 0x20 || c == 0x7F; };
  return !name.empty() && name.size() <= 100 && name[0] != '.' && name[0] != '-' &&
         std::ranges::none_of(name, bad) && name != "clips" && name != "dataset.json" &&
         name != "manifest.jsonl";
}

bool IsTestClip(int64_t clip, double test_fraction) {
  // A product like 100 * 0.29 comes out just below the whole number that it is; rounding adds at most 2.3e-7
  // for clips up to 1e9, so a millionth is enough. It moves no share: both sides of the comparison have it.
  constexpr double kRounding = 1e-6;
  const auto test_clips_before = [&](int64_t clips) { return std::floor(clips * test_fraction + kRounding); };
  return test_clips_before(clip + 1) > test_clips_before(clip);
}

int PairDigits(int64_t clips, int64_t frames_per_clip) { return clips > 1'000'000 / frames_per_clip ? 9 : 6; }

}  // namespace shimmer::dataset
