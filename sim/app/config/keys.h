// The keys of a config as a tree of values, listed from the structs' Fields: what reading, checks, schema and
// help walk.
#pragma once

#include <string>
#include <vector>

#include "sim/app/config/config.h"
#include "sim/app/config/error.h"

namespace shimmer::app {

enum class Kind {
  kSection,  // an object of further keys
  kList,     // a list of such objects
  kReal,
  kInteger,
  kFlag,    // true or false
  kName,    // one of field.names
  kText,    // any text
  kTexts,   // a list of texts (of field.names, where there are some)
  kSize,    // [width, height]
  kPoints,  // [[x, y], ...], numbers in the key's range
};

struct Key {
  std::string path;     // "tilt.strength_px"; "" for the whole config
  std::string pointer;  // "/tilt/strength_px"
  Field field;          // of a section or what is reserved: name and help alone
  Kind kind;
  Json low = {}, high = {};      // field's range, as numbers of the key's kind; null where it has no end
  std::string allowed = {};      // field's range in words, with the unit
  Json fallback = {};            // value where the config gives none; of an alternative: none (null)
  const void* member = nullptr;  // of a value: where it is in DefaultConfig()
  std::vector<Key> keys = {};    // of a section, in the order of its Fields; of a list, those of each element

  std::string name() const { return field.name; }
};

const Config& DefaultConfig();
const Key& AllKeys();

// The key of a member of DefaultConfig(): KeyOf(DefaultConfig().blur.min_sigma_px).
// Throws std::invalid_argument for anything that is no such member.
const Key& KeyAt(const void* member);
const Key& KeyOf(const auto& member) { return KeyAt(&member); }

// Element i of a list, as a section: "objects.2", "/objects/2".
Key ElementOf(const Key& list, size_t index);

std::vector<std::string> KeyNames(const Key& section);

// Says that a section has no such key, and which one may be meant: a near name, or the same name in another
// section.
ConfigError NoSuchKey(const Key& section, const std::string& name);

// Copies the values that a resolved config holds into config. Left as they are: members whose value is a
// distribution, and alternatives that are not given.
void Fill(const Json& resolved, Config& config);

}  // namespace shimmer::app
