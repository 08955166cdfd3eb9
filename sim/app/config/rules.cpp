#include "sim/app/config/rules.h"

#include <algorithm>
#include <string>
#include <vector>

#include "cli/listed.h"
#include "sim/app/config/distribution.h"
#include "sim/app/config/keys.h"
#include "sim/dataset/layout.h"

namespace shimmer::app {
namespace {

constexpr int64_t kFramesEnd = int64_t{1} << 31;  // every frame's time is below this

// Of a section's alternatives exactly one is given.
void CheckAlternatives(const Key& section, const Json& values) {
  std::vector<std::string> names, given;
  for (const Key& key : section.keys) {
    if (key.kind == Kind::kSection) CheckAlternatives(key, values.at(key.name()));
    if (key.kind == Kind::kList)
      for (size_t i = 0; i < values.at(key.name()).size(); ++i)
        CheckAlternatives(ElementOf(key, i), values.at(key.name())[i]);
    if (!key.field.alternative) continue;
    names.push_back(key.name());
    if (values.contains(key.name())) given.push_back(key.name());
  }
  if (names.empty() || given.size() == 1) return;
  if (given.empty())
    throw ConfigError(section.pointer,
                      "has none of " + cli::Listed(names, "and") + ", must have exactly one");
  throw ConfigError(section.pointer, "has " + cli::Listed(given, "and") + ", must have exactly one of " +
                                         cli::Listed(names, "and") + " (--set " + section.path + "." +
                                         given.front() + "=null takes one away)");
}

void CheckSigmas(const Json& resolved) {
  const sim::BlurParams& blur = DefaultConfig().blur;
  const Key &min_key = KeyOf(blur.min_sigma_px), &max_key = KeyOf(blur.max_sigma_px);
  const Json& min = resolved.at(Json::json_pointer(min_key.pointer));
  const Json& max = resolved.at(Json::json_pointer(max_key.pointer));
  if (SupportOf(min).high > SupportOf(max).low)
    throw ConfigError(min_key.pointer, "is " + Shown(min) + ", must never exceed " + max_key.path +
                                           ", which is " + Shown(max));
}

void CheckFrames(const Config& fixed) {
  const Config& all = DefaultConfig();
  const Key &first_key = KeyOf(all.first_frame), &frames_key = KeyOf(all.frames);
  if (fixed.first_frame + fixed.frames > kFramesEnd)
    throw ConfigError(first_key.pointer, "is " + std::to_string(fixed.first_frame) + ", must be at most " +
                                             std::to_string(kFramesEnd - fixed.frames) + " for " +
                                             frames_key.path + " = " + std::to_string(fixed.frames));
  const Key& kept_key = KeyOf(all.output.frames_per_clip);
  if (fixed.output.frames_per_clip > fixed.frames)
    throw ConfigError(kept_key.pointer, "is " + std::to_string(fixed.output.frames_per_clip) +
                                            ", must be at most " + frames_key.path + " = " +
                                            std::to_string(fixed.frames));
}

// The REDS loader of BasicSR counts on 100 frames a clip, and numbers clips with three digits.
void CheckBasicsr(const Config& fixed) {
  constexpr int kRedsFrames = 100;
  if (fixed.output.layout != LayoutKind::kBasicsr || fixed.output.any_length || fixed.frames == kRedsFrames)
    return;
  const Config& all = DefaultConfig();
  throw ConfigError(KeyOf(all.frames).pointer,
                    "is " + std::to_string(fixed.frames) + ", must be " + std::to_string(kRedsFrames) +
                        " where output.layout is basicsr, for its loader wants that (" +
                        KeyOf(all.output.any_length).path + "=true allows others)");
}

void CheckOutput(const OutputParams& output) {
  const OutputParams& all = DefaultConfig().output;
  const std::vector<int> bits = output.format == Format::kPng ? std::vector{8, 16} : std::vector{16, 32};
  if (std::find(bits.begin(), bits.end(), output.bits) == bits.end()) {
    const Key& format_key = KeyOf(all.format);
    throw ConfigError(KeyOf(all.bits).pointer,
                      "is " + std::to_string(output.bits) + ", must be " + std::to_string(bits[0]) + " or " +
                          std::to_string(bits[1]) + " where " + format_key.path + " is " +
                          format_key.field.names.at(static_cast<size_t>(output.format)));
  }
  if (!dataset::IsPlainFolderName(output.name))
    throw ConfigError(KeyOf(all.name).pointer,
                      "is " + Shown(output.name) +
                          ", must be the plain name of a folder: no '/' nor '\\', no control "
                          "characters, no '.' or '-' at its start, not \"clips\"");
}

}  // namespace

void CheckRules(const Json& resolved, const Config& fixed) {
  CheckAlternatives(AllKeys(), resolved);
  CheckSigmas(resolved);
  CheckFrames(fixed);
  CheckBasicsr(fixed);
  CheckOutput(fixed.output);
  CheckSceneRules(resolved, fixed);
}

}  // namespace shimmer::app
