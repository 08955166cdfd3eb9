#include "restore/model_card.h"

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace shimmer::restore {
namespace {

using Json = nlohmann::json;

constexpr int kLeastLevels = 2, kMostLevels = 6, kMostBlocks = 64, kMostDepth = 16;
constexpr int kMostWidth = 512, kMostHeads = 1024;
constexpr double kMostExpansion = 16;

class Card {
 public:
  Card(const Json& json, const std::string& file) : json_(json), file_(file) {}

  [[noreturn]] void Refuse(const std::string& what) const {
    throw std::runtime_error(file_ + ": the model card's " + what);
  }
  [[noreturn]] void Refuse(const std::string& key, const Json& value, const std::string& right) const {
    Refuse(key + " = " + value.dump() + ", must be " + right);
  }

  const Json& At(const std::string& key, const std::string& right) const {
    if (!json_.contains(key)) Refuse(key + " is missing, must be " + right);
    return json_.at(key);
  }

  int Whole(const std::string& key, const Json& value, int least, int most) const {
    if (!value.is_number_integer() || value < least || value > most) Refuse(key, value, Range(least, most));
    return value.get<int>();
  }
  int Whole(const std::string& key, int least, int most) const {
    return Whole(key, At(key, Range(least, most)), least, most);
  }

  std::vector<int> PerLevel(const std::string& key, int most) const {
    const std::string right = "a list of " + std::to_string(kLeastLevels) + " to " +
                              std::to_string(kMostLevels) + " numbers, one a level";
    const Json& values = At(key, right);
    if (!values.is_array() || values.size() < kLeastLevels || values.size() > kMostLevels)
      Refuse(key, values, right);
    std::vector<int> numbers;
    for (size_t i = 0; i < values.size(); ++i)
      numbers.push_back(Whole(key + "[" + std::to_string(i) + "]", values[i], 1, most));
    return numbers;
  }

  std::string OneOf(const std::string& key, const std::vector<std::string>& choices) const {
    std::string right;
    for (const std::string& choice : choices) right += (right.empty() ? "\"" : " or \"") + choice + "\"";
    const Json& value = At(key, right);
    for (const std::string& choice : choices)
      if (value == choice) return choice;
    Refuse(key, value, right);
  }

 private:
  static std::string Range(int least, int most) {
    return "a whole number in [" + std::to_string(least) + ", " + std::to_string(most) + "]";
  }

  const Json& json_;
  const std::string& file_;
};

RestormerShape ShapeOf(const Card& card) {
  RestormerShape shape;
  shape.width = card.Whole("width", 2, kMostWidth);
  if (shape.width % 2 != 0) card.Refuse("width", shape.width, "even: half of it goes down a level");
  shape.blocks = card.PerLevel("blocks", kMostBlocks);
  shape.heads = card.PerLevel("heads", kMostHeads);
  if (shape.heads.size() != shape.blocks.size())
    card.Refuse("heads", shape.heads, std::to_string(shape.blocks.size()) + " numbers, as blocks has");
  for (int level = 0; level < shape.Levels(); ++level) {
    const int heads = shape.heads[static_cast<size_t>(level)], channels = shape.Channels(level);
    if (channels % heads != 0)
      card.Refuse("heads[" + std::to_string(level) + "]", heads,
                  "a divisor of the level's " + std::to_string(channels) + " channels");
  }
  shape.refinement = card.Whole("refinement", 0, kMostBlocks);
  const std::string expansion = "a number in (0, 16] that gives a hidden channel or more";
  const Json& value = card.At("expansion", expansion);
  if (!value.is_number() || !(value.get<double>() > 0 && value.get<double>() <= kMostExpansion))
    card.Refuse("expansion", value, expansion);
  shape.expansion = value.get<double>();
  if (shape.Hidden(shape.width) < 1) card.Refuse("expansion", value, expansion);
  shape.norm_with_bias = card.OneOf("norm", {"with_bias", "bias_free"}) == "with_bias";
  shape.unshuffle = card.Whole("unshuffle", 1, 8);
  if ((shape.unshuffle & (shape.unshuffle - 1)) != 0)
    card.Refuse("unshuffle", shape.unshuffle, "1, 2, 4 or 8");
  return shape;
}

Json Parsed(const std::string& text, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error(file + ": its model card " + what);
  };
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  const auto check = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kMostDepth) refuse("is nested too deep");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
      refuse("has " + value.get<std::string>() + " twice");
    return true;
  };
  Json json;
  try {
    json = Json::parse(text, check);
  } catch (const Json::exception& error) {
    refuse(std::string("is no JSON: ") + error.what());
  }
  if (!json.is_object()) refuse("is no JSON object");
  return json;
}

Json JsonOf(const SafeTensors& file) {
  const auto text = file.metadata.find("card");
  if (text == file.metadata.end())
    throw std::runtime_error(file.file + ": has no model card, which __metadata__'s \"card\" must be");
  return Parsed(text->second, file.file);
}

}  // namespace

TileCard ReadTileCard(const SafeTensors& file) {
  const Json json = JsonOf(file);
  const Card card(json, file.file);
  card.Whole("format", 1, 1);
  TileCard read;
  read.text = file.metadata.at("card");
  const Json& name = card.At("name", "a text");
  if (!name.is_string() || name.get<std::string>().empty()) card.Refuse("name", name, "a text");
  read.name = name.get<std::string>();
  read.tile_px = card.Whole("tile", 16, 16384);
  read.overlap_px = card.Whole("overlap", 0, (read.tile_px - 1) / 2);
  return read;
}

ModelCard ReadModelCard(const SafeTensors& file) {
  const Json json = JsonOf(file);
  const Card card(json, file.file);
  card.OneOf("network", {"restormer"});
  ModelCard read;
  read.shape = ShapeOf(card);
  static_cast<TileCard&>(read) = ReadTileCard(file);
  return read;
}

}  // namespace shimmer::restore
