#include "restore/app/evaluation/variants.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "restore/app/settings_options.h"
#include "restore/open_network.h"
#include "sim/dataset/sha256.h"

namespace shimmer::restore::app {
namespace {

// What the paper leaves out in turn, and other ways to find what moves.
constexpr const char* kAblations[] = {
    "no-stabilise:stabilise=off", "no-segment:segment=off", "no-stack:stack=off",
    "no-sharpen:sharpen=off",     "aof:segment=aof",        "flow-farneback:flow=farneback"};

struct NamedBaseline {
  const char* name;
  Baseline baseline;
};
constexpr NamedBaseline kBaselines[] = {{"mean", Baseline::kMean},
                                        {"median", Baseline::kMedian},
                                        {"lucky", Baseline::kLucky},
                                        {"unsharp", Baseline::kSharpen}};

std::vector<std::string> Split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

Variant Changed(const std::string& text, const RestoreSettings& settings) {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || colon + 1 == text.size())
    throw std::invalid_argument("--variant " + text +
                                ": must be NAME:SETTING=VALUE,..., as no-stack:stack=off");
  Variant variant{.name = text.substr(0, colon),
                  .kind = VariantKind::kAblation,
                  .changes = text.substr(colon + 1),
                  .settings = settings};
  for (const std::string& change : Split(variant.changes, ',')) {
    const size_t equals = change.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument("--variant " + text + ": '" + change + "' must be SETTING=VALUE");
    try {
      ChangeSetting(variant.settings, change.substr(0, equals), change.substr(equals + 1));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("--variant " + text + ": " + error.what());
    }
  }
  return variant;
}

Variant Method(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size())
    throw std::invalid_argument("--method " + text + ": must be NAME=FOLDER");
  return {.name = text.substr(0, equals),
          .kind = VariantKind::kMethod,
          .settings = {},
          .folder = text.substr(equals + 1)};
}

void RequireNames(const std::vector<Variant>& variants) {
  for (size_t i = 0; i < variants.size(); ++i) {
    const std::string& name = variants[i].name;
    const bool good =
        !name.empty() && name[0] != '.' && name.size() <= 60 && std::ranges::all_of(name, [](char c) {
          return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
        });
    if (!good)
      throw std::invalid_argument("variant '" + name +
                                  "': its name must be of letters, digits, '.', '_' and '-'");
    for (size_t k = 0; k < i; ++k)
      if (variants[k].name == name) throw std::invalid_argument("variant '" + name + "': the name is taken");
  }
}

const char* OnOff(bool on) { return on ? "on" : "off"; }

}  // namespace

VariantText Variant::Text() const {
  std::string settings_text = changes;
  if (kind == VariantKind::kMethod) settings_text = folder.string();
  return {name, kind, settings_text};
}

nlohmann::json Variant::Identity() const {
  nlohmann::json identity = {{"kind", NameOf(kind)}};
  if (kind == VariantKind::kMethod) identity["folder"] = std::filesystem::absolute(folder).lexically_normal();
  if (kind == VariantKind::kMethod || kind == VariantKind::kInput) return identity;
  const RestoreParams& params = settings.params;
  identity["stabilise"] = OnOff(params.stabilise);
  if (kind == VariantKind::kBaseline) return identity;
  identity["segment"] = !params.segment ? "off" : params.method == SegmentMethod::kFused ? "fused" : "aof";
  identity["flow"] = settings.flow;
  identity["register"] =
      params.registered == Register::kAuto ? "auto" : OnOff(params.registered == Register::kOn);
  identity["stack"] = OnOff(params.stack);
  identity["sharpen"] = !settings.sharpen        ? "off"
                        : settings.model.empty() ? dataset::Sha256Hex(ShippedModel())
                                                 : dataset::Sha256HexOfFile(settings.model);
  return identity;
}

std::vector<Variant> VariantsOf(const VariantOptions& options) {
  if (options.settings.params.border == Border::kCrop)
    throw std::invalid_argument(
        "--border crop: frames must keep their size to be held against the truth, must be fill");
  std::vector<Variant> variants = {
      {.name = kInputName, .kind = VariantKind::kInput, .settings = {}},
      {.name = kFullName, .kind = VariantKind::kPipeline, .settings = options.settings}};
  if (options.ablations)
    for (const char* ablation : kAblations) variants.push_back(Changed(ablation, options.settings));
  for (const std::string& changed : options.changed) variants.push_back(Changed(changed, options.settings));
  if (options.baselines)
    for (const auto& [name, baseline] : kBaselines)
      variants.push_back(
          {.name = name, .kind = VariantKind::kBaseline, .settings = options.settings, .baseline = baseline});
  for (const std::string& method : options.methods) variants.push_back(Method(method));
  RequireNames(variants);
  return variants;
}

}  // namespace shimmer::restore::app
