// What is wrong with a config, where, and the words to say it in one line.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>

namespace shimmer::app {

using Json = nlohmann::json;

// what() is one line without the file's name: "is -3, must be in [0, 64] px".
class ConfigError : public std::invalid_argument {
 public:
  ConfigError(std::string pointer, const std::string& message)
      : std::invalid_argument(message), pointer_(std::move(pointer)) {}
  const std::string& pointer() const {
    return pointer_;
  }  // JSON pointer, "/tilt/strength_px"; "" the whole file

 private:
  std::string pointer_;
};

// A value as it stands in a message: compact JSON, cut short. One line whatever the value holds.
std::string Shown(const Json& value);

// A key or text likewise, without quotes.
std::string ShownText(const std::string& text);

// The JSON pointer of a key, or of an element, of what is at pointer.
std::string PointerUnder(const std::string& pointer, const std::string& key);
std::string PointerUnder(const std::string& pointer, size_t index);

// The candidate that name most likely stands for: few letters changed, added, left out or swapped. "" if none
// is near.
std::string Closest(const std::string& name, std::span<const std::string> candidates);

// "unknown key 'strenght_px'; did you mean 'strength_px'?", or the list of what there is.
std::string UnknownKey(const std::string& name, std::span<const std::string> known);

// Throw ConfigError.
void RequireObject(const Json& value, const std::string& pointer);
void RequireUtf8(const std::string& text, const std::string& pointer);

}  // namespace shimmer::app
