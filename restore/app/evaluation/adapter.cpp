#include "restore/app/evaluation/adapter.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cli/listed.h"
#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kClip = "{clip}";

[[noreturn]] void Refuse(const fs::path& file, const std::string& key, const std::string& what) {
  throw std::invalid_argument(file.string() + ": " + key + what);
}

void RequirePath(const fs::path& file, const std::string& key, const std::string& text, bool names_clips) {
  const size_t at = text.find(kClip);
  if (text.empty() || fs::path(text).is_absolute())
    Refuse(file, key, ": must be a path below the data set's folder");
  if (names_clips && at != std::string::npos && text.find(kClip, at + 1) != std::string::npos)
    Refuse(file, key, ": must have {clip} once at most");
  if (dataset::HasWildcards(text)) Refuse(file, key, ": must have no * ? or [, but {clip} for a clip's name");
}

void Take(Adapter& adapter, const fs::path& file, const std::string& key, const nlohmann::json& value) {
  const std::map<std::string, std::string*> texts = {{"name", &adapter.name}, {"about", &adapter.about}};
  const std::map<std::string, AdapterPath*> paths = {
      {"turb", &adapter.turb}, {"clean", &adapter.clean}, {"mask", &adapter.mask}, {"warp", &adapter.warp}};
  if (const auto text = texts.find(key); text != texts.end()) {
    if (!value.is_string()) Refuse(file, key, ": must be a text");
    *text->second = value;
  } else if (const auto path = paths.find(key); path != paths.end()) {
    if (!value.is_string()) Refuse(file, key, ": must be a text");
    path->second->text = value;
    RequirePath(file, key, value, key == "turb");
  } else if (key == "frames" || key == "margin_px") {
    if (!value.is_number_integer() || value < 0 || value > 1'000'000)
      Refuse(file, key, ": must be a whole number, 0 or more");
    if (key == "frames")
      adapter.frames = value;
    else
      adapter.margin_px = value;
  } else {
    Refuse(file, key,
           ": there is no such key, must be one of " +
               cli::Listed(std::vector<std::string>{"name", "about", "turb", "clean", "mask", "warp",
                                                    "frames", "margin_px"},
                           "and"));
  }
}

}  // namespace

fs::path AdapterPath::Of(const std::string& clip) const {
  std::string path = text;
  for (size_t at = 0; (at = path.find(kClip, at)) != std::string::npos; at += clip.size())
    path.replace(at, kClip.size(), clip);
  return path;
}

std::vector<std::string> Adapter::ClipsIn(const fs::path& folder) const {
  // What stands for {clip}, in the folder or file name that it is a part of.
  fs::path above, part;
  for (const fs::path& each : fs::path(turb.text)) {
    part = each;
    if (each.string().find(kClip) != std::string::npos) break;
    above /= each;
  }
  const std::string text = part.string();
  const size_t at = text.find(kClip);
  if (at == std::string::npos) return {name};
  const std::string before = text.substr(0, at), after = text.substr(at + kClip.size());
  // In the file names themselves a frame's number follows: clips are told apart by what stands before it.
  const size_t number = after.find('%');
  const std::string until = after.substr(0, number);
  std::vector<std::string> clips;
  for (const fs::path& entry : dataset::VisibleEntries(folder / above)) {
    std::string found = entry.filename().string();
    if (!found.starts_with(before)) continue;
    found = found.substr(before.size());
    if (number == std::string::npos) {
      if (!found.ends_with(until) || found.size() <= until.size()) continue;
      found.resize(found.size() - until.size());
    } else {
      const size_t end = until.empty() ? found.find_first_of("0123456789") : found.rfind(until);
      if (end == std::string::npos || end == 0) continue;
      found.resize(end);
    }
    clips.push_back(found);
  }
  std::ranges::sort(clips);
  clips.erase(std::ranges::unique(clips).begin(), clips.end());
  return clips;
}

Adapter ReadAdapter(const fs::path& file) {
  const std::vector<uint8_t> bytes = dataset::ReadFile(file);
  Adapter adapter;
  try {
    adapter.json = nlohmann::json::parse(bytes);
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(file.string() + ": is no JSON (" + error.what() + ")");
  }
  if (!adapter.json.is_object()) throw std::invalid_argument(file.string() + ": must be a JSON object");
  for (const auto& [key, value] : adapter.json.items()) Take(adapter, file, key, value);
  if (adapter.name.empty()) Refuse(file, "name", ": is missing");
  if (adapter.turb.empty()) Refuse(file, "turb", ": is missing, must say where the turbulent frames are");
  if (adapter.clean.empty() && adapter.mask.empty())
    Refuse(file, "clean", ": is missing, and so is mask: one of them must say where the truth is");
  return adapter;
}

}  // namespace shimmer::restore::app
