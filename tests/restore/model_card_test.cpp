#include "restore/model_card.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/restore/safe_tensor_file.h"

namespace shimmer::restore {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

Json GoodCard() {
  return Json::parse(
      R"({"format": 1, "network": "restormer", "name": "small", "width": 16, "blocks": [2, 2, 4],
    "heads": [1, 2, 4], "refinement": 1, "expansion": 2.66, "norm": "bias_free", "unshuffle": 2, "tile": 256,
    "overlap": 32})");
}

ModelCard Read(const std::string& text) { return ReadModelCard({"small.safetensors", {{"card", text}}, {}}); }

std::string Refusal(const std::string& text) {
  const std::string error = ErrorOf([&] { Read(text); });
  EXPECT_THAT(error, testing::StartsWith("small.safetensors: "));
  EXPECT_THAT(error, testing::Not(HasSubstr("\n")));
  return error;
}

std::string RefusalOf(const std::string& key, const Json& value) {
  Json card = GoodCard();
  card[key] = value;
  return Refusal(card.dump());
}

TEST(ModelCard, AllOfItIsRead) {
  Json json = GoodCard();
  json["seed"] = 7;
  json["curve"] = {{"psnr_db", {20.5, 21.0}}};
  const ModelCard card = Read(json.dump());
  EXPECT_EQ(card.name, "small");
  EXPECT_EQ(card.shape.width, 16);
  EXPECT_THAT(card.shape.blocks, ElementsAre(2, 2, 4));
  EXPECT_THAT(card.shape.heads, ElementsAre(1, 2, 4));
  EXPECT_EQ(card.shape.refinement, 1);
  EXPECT_DOUBLE_EQ(card.shape.expansion, 2.66);
  EXPECT_FALSE(card.shape.norm_with_bias);
  EXPECT_EQ(card.shape.unshuffle, 2);
  EXPECT_EQ(card.tile_px, 256);
  EXPECT_EQ(card.overlap_px, 32);
  EXPECT_EQ(card.text, json.dump());
}

TEST(ModelCard, SizesFollowFromTheShape) {
  const RestormerShape shape = Read(GoodCard().dump()).shape;
  EXPECT_EQ(shape.Levels(), 3);
  EXPECT_EQ(shape.Channels(2), 64);
  EXPECT_EQ(shape.DecoderChannels(0), 32);
  EXPECT_EQ(shape.DecoderChannels(1), 32);
  EXPECT_EQ(shape.Hidden(64), 170);
  EXPECT_EQ(shape.SizeMultiple(), 8);
}

TEST(ModelCard, FilesWithoutOneAreRefused) {
  EXPECT_THAT(ErrorOf([] {
                ReadModelCard({"a.safetensors", {{"format", "pt"}}, {}});
              }),
              HasSubstr("a.safetensors: has no model card"));
  EXPECT_THAT(Refusal("{"), HasSubstr("its model card is no JSON"));
  EXPECT_THAT(Refusal("7"), HasSubstr("its model card is no JSON object"));
  EXPECT_THAT(Refusal(std::string(100000, '[')), HasSubstr("nested too deep"));
  EXPECT_THAT(Refusal(R"({"format": 1, "format": 1})"), HasSubstr("has format twice"));
}

TEST(ModelCard, EveryKeyIsNeeded) {
  const Json good = GoodCard();
  for (const auto& [key, value] : good.items()) {
    Json card = good;
    card.erase(key);
    EXPECT_THAT(Refusal(card.dump()), HasSubstr("the model card's " + key + " is missing, must be "));
  }
}

TEST(ModelCard, AnotherNetworkIsRefused) {
  EXPECT_THAT(RefusalOf("format", 2), HasSubstr("format = 2, must be a whole number in [1, 1]"));
  EXPECT_THAT(RefusalOf("network", "unet"), HasSubstr("network = \"unet\", must be \"restormer\""));
  EXPECT_THAT(RefusalOf("norm", "batch"),
              HasSubstr("norm = \"batch\", must be \"with_bias\" or \"bias_free\""));
  EXPECT_THAT(RefusalOf("name", ""), HasSubstr("name = \"\", must be a text"));
  EXPECT_THAT(RefusalOf("name", 5), HasSubstr("name = 5, must be a text"));
}

TEST(ModelCard, SizesThatAreNoneAreRefused) {
  for (const Json& width :
       {Json(0), Json(-16), Json(1 << 20), Json(16.5), Json("16"), Json(nullptr), Json(1e300)})
    EXPECT_THAT(RefusalOf("width", width),
                HasSubstr("width = " + width.dump() + ", must be a whole number in [2, 512]"));
  EXPECT_THAT(RefusalOf("width", 15), HasSubstr("width = 15, must be even"));
  EXPECT_THAT(RefusalOf("blocks", 4), HasSubstr("blocks = 4, must be a list of 2 to 6 numbers"));
  EXPECT_THAT(RefusalOf("blocks", {4}), HasSubstr("blocks = [4], must be a list of 2 to 6 numbers"));
  EXPECT_THAT(RefusalOf("blocks", {2, 0, 4}), HasSubstr("blocks[1] = 0, must be a whole number in [1, 64]"));
  EXPECT_THAT(RefusalOf("blocks", {2, 2, 1000000000}), HasSubstr("blocks[2] = 1000000000, must be"));
  EXPECT_THAT(RefusalOf("heads", {1, 2}), HasSubstr("heads = [1,2], must be 3 numbers, as blocks has"));
  EXPECT_THAT(RefusalOf("heads", {1, 3, 4}),
              HasSubstr("heads[1] = 3, must be a divisor of the level's 32 channels"));
  EXPECT_THAT(RefusalOf("heads", {1, 0, 4}), HasSubstr("heads[1] = 0, must be"));
  EXPECT_THAT(RefusalOf("refinement", -1), HasSubstr("refinement = -1, must be a whole number in [0, 64]"));
  for (const Json& expansion : {Json(0), Json(-1), Json(17), Json("2"), Json(0.01)})
    EXPECT_THAT(RefusalOf("expansion", expansion),
                HasSubstr("expansion = " + expansion.dump() + ", must be a number"));
  EXPECT_THAT(RefusalOf("unshuffle", 3), HasSubstr("unshuffle = 3, must be 1, 2, 4 or 8"));
  EXPECT_THAT(RefusalOf("unshuffle", 0), HasSubstr("unshuffle = 0, must be"));
  EXPECT_THAT(RefusalOf("tile", 8), HasSubstr("tile = 8, must be a whole number in [16, 16384]"));
  EXPECT_THAT(RefusalOf("overlap", 128), HasSubstr("overlap = 128, must be a whole number in [0, 127]"));
  EXPECT_THAT(RefusalOf("overlap", -1), HasSubstr("overlap = -1, must be"));
}

}  // namespace
}  // namespace shimmer::restore
