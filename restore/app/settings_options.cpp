#include "restore/app/settings_options.h"

#include <map>
#include <stdexcept>
#include <vector>

#include "cli/listed.h"

namespace shimmer::restore::app {
namespace {

const std::map<std::string, Border> kBorders = {{"fill", Border::kFill}, {"crop", Border::kCrop}};
const std::map<std::string, SegmentMethod> kMethods = {{"fused", SegmentMethod::kFused},
                                                       {"aof", SegmentMethod::kAof}};
const std::map<std::string, Register> kRegisters = {
    {"auto", Register::kAuto}, {"on", Register::kOn}, {"off", Register::kOff}};
const std::map<std::string, bool> kSwitches = {{"on", true}, {"off", false}};

template <class Map>
std::vector<std::string> KeysOf(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

template <class T>
T OneOf(const std::map<std::string, T>& values, const std::string& value,
        const std::vector<std::string>& more = {}) {
  if (const auto found = values.find(value); found != values.end()) return found->second;
  std::vector<std::string> names = KeysOf(values);
  names.insert(names.end(), more.begin(), more.end());
  throw std::invalid_argument("must be " + cli::Listed(names, "or"));
}

void ChangeSegment(RestoreSettings& settings, const std::string& value) {
  settings.params.segment = value != "off";
  if (settings.params.segment) settings.params.method = OneOf(kMethods, value, {"off"});
}

void ChangeRegister(RestoreSettings& settings, const std::string& value) {
  settings.params.registered = OneOf(kRegisters, value);
}
void ChangeFlow(RestoreSettings& settings, const std::string& value) { settings.flow = value; }
void ChangeModel(RestoreSettings& settings, const std::string& value) { settings.model = value; }

template <bool& (*kMember)(RestoreSettings&)>
void Switch(RestoreSettings& settings, const std::string& value) {
  kMember(settings) = OneOf(kSwitches, value);
}
bool& Stabilise(RestoreSettings& settings) { return settings.params.stabilise; }
bool& Stack(RestoreSettings& settings) { return settings.params.stack; }
bool& Sharpen(RestoreSettings& settings) { return settings.sharpen; }

using Change = void (*)(RestoreSettings& settings, const std::string& value);
const std::map<std::string, Change> kChanges = {{"stabilise", Switch<Stabilise>},
                                                {"segment", ChangeSegment},
                                                {"flow", ChangeFlow},
                                                {"register", ChangeRegister},
                                                {"stack", Switch<Stack>},
                                                {"sharpen", Switch<Sharpen>},
                                                {"model", ChangeModel}};

}  // namespace

void AddSettingsOptions(CLI::App& command, RestoreSettings& settings) {
  command
      .add_option("--border", settings.params.border,
                  "what a steadied frame does not see: fill takes it from neighbouring "
                  "frames (default), crop cuts to what all frames see")
      ->transform(CLI::CheckedTransformer(kBorders));
  command.add_flag("!--no-stabilise", settings.params.stabilise, "take the camera to have stood");
  command
      .add_option(
          "--segment", settings.params.method,
          "how what moves is found: fused, by what lies outside of the still scene (default), or aof, the "
          "paper's averaged flow")
      ->transform(CLI::CheckedTransformer(kMethods));
  command.add_option(
      "--flow", settings.flow,
      "the optical flow by which what moves is found: dis (default) or farneback, both OpenCV's, or a "
      "network's, a file of TorchScript as raft.pt, in builds that have it");
  command
      .add_option("--register", settings.params.registered,
                  "whether frames are registered to one another before they are averaged: auto (default), "
                  "on or off")
      ->transform(CLI::CheckedTransformer(kRegisters));
  command.add_flag("!--no-segment", settings.params.segment, "take it that nothing moves");
  command.add_flag("!--no-stack", settings.params.stack, "leave the turbulence as it is: stabilise alone");
  CLI::Option* no_sharpen =
      command.add_flag("!--no-sharpen", settings.sharpen, "leave out the network that sharpens");
  command
      .add_option("--model", settings.model,
                  "the network that sharpens: weights in .safetensors, or any in .onnx or, in builds that "
                  "have TorchScript, .pt (default: the one that unshimmer carries)")
      ->excludes(no_sharpen);
}

void ChangeSetting(RestoreSettings& settings, const std::string& key, const std::string& value) {
  const auto change = kChanges.find(key);
  if (change == kChanges.end())
    throw std::invalid_argument(key + "=" + value + ": there is no such setting, must be one of " +
                                cli::Listed(KeysOf(kChanges), "and"));
  try {
    change->second(settings, value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(key + "=" + value + ": " + error.what());
  }
}

}  // namespace shimmer::restore::app
