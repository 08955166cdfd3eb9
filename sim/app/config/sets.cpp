#include "sim/app/config/sets.h"

#include <algorithm>

#include "sim/app/config/json_reader.h"
#include "sim/app/config/keys.h"

namespace shimmer::app {
namespace {

bool IsIndex(const std::string& name) {
  return !name.empty() && name.size() <= 6 && name.find_first_not_of("0123456789") == std::string::npos;
}

Key KeyNamed(const std::string& path) {
  Key key = AllKeys();
  size_t start = 0;
  while (start <= path.size()) {
    const size_t end = std::min(path.find('.', start), path.size());
    const std::string name = path.substr(start, end - start);
    if (key.kind == Kind::kList && IsIndex(name)) {
      key = ElementOf(key, std::stoul(name));
    } else {
      if (key.kind != Kind::kSection)
        throw ConfigError(PointerUnder(key.pointer, name),
                          "unknown key '" + ShownText(name) + "'; " + key.path + " is set as a whole");
      const auto found = std::ranges::find(key.keys, name, &Key::name);
      if (found == key.keys.end()) throw NoSuchKey(key, name);
      key = Key(*found);
    }
    start = end + 1;
  }
  if (key.kind == Kind::kSection)
    throw ConfigError(key.pointer,
                      "is a section; set one of its keys, as " + key.keys.front().path + "=VALUE");
  return key;
}

Json ValueOf(const std::string& text, const std::string& pointer) {
  try {
    return ReadJson(text);
  } catch (const JsonSyntaxError&) {
    RequireUtf8(text, pointer);
    return text;
  } catch (const ConfigError& error) {
    throw ConfigError(pointer + error.pointer(), error.what());
  }
}

}  // namespace

void ApplySet(const std::string& set, Json& given) {
  const size_t equals = set.find('=');
  if (equals == std::string::npos)
    throw ConfigError("", "--set " + ShownText(set) + ", must be PATH=VALUE, as " +
                              KeyOf(DefaultConfig().tilt.strength_px).path + "=5");
  const Key key = KeyNamed(set.substr(0, equals));
  const Json value = ValueOf(set.substr(equals + 1), key.pointer);

  const Json::json_pointer place(key.pointer);
  for (auto part = place.parent_pointer(); !part.empty(); part = part.parent_pointer())
    if (given.contains(part) && !given[part].is_array()) RequireObject(given[part], part.to_string());
  if (!value.is_null())
    given[place] = value;
  else if (given.contains(place))
    given[place.parent_pointer()].erase(place.back());
}

}  // namespace shimmer::app
