// The config: one JSON file that says a whole data set. Its keys are contracts (docs/formats.md,
// configs/schema.json); they are listed in params.h and sim/scene.h.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sim/app/config/error.h"
#include "sim/app/config/params.h"

namespace shimmer::app {

// A config that has been read, checked and completed with every default.
class ConfigFile {
 public:
  // text: a JSON object. sets: "tilt.strength_px=5", each overriding a key in turn; the value is read as
  // JSON, or taken as text where it is none; null takes the key away. Throws ConfigError with the pointer of
  // the key.
  static ConfigFile Parse(const std::string& text, std::span<const std::string> sets = {});

  // Every key with its value, numbers of their field's own kind, distributions complete (clip and weights
  // too). Of a section's alternatives (source.images and its siblings) the given one alone. Parsed again, it
  // is the same.
  const Json& resolved() const { return resolved_; }

  // The values that hold for the whole set. What is drawn for each clip has its default here.
  const Config& fixed() const { return fixed_; }

  // The width and the height that no clip exceeds.
  cv::Size LargestSize() const;

  // Values of one clip. drawn, where not null: an object of every drawn value by its path
  // ("tilt.strength_px").
  Config Draw(uint64_t clip, Json* drawn) const;

  // SHA-256 (hex) of the resolved config without "clips", as Python's json.dumps(config, sort_keys=True,
  // separators=(",", ":")) writes it: keys sorted, shortest numbers.
  std::string Hash() const;

 private:
  Json resolved_;
  Config fixed_;
};

std::string SchemaText();    // configs/schema.json
std::string KeysHelpText();  // every key with its range, unit, default and meaning, for people

}  // namespace shimmer::app
