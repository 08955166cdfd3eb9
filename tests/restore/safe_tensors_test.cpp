#include "restore/safe_tensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/restore/safe_tensor_file.h"

namespace shimmer::restore {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string Refusal(const std::string& bytes) {
  const TemporaryFile file(bytes);
  const std::string error = ErrorOf([&] { ReadSafeTensors(file.Path()); });
  EXPECT_THAT(error, testing::StartsWith(file.Path().string() + ": "));
  EXPECT_THAT(error, testing::Not(HasSubstr("\n")));
  return error;
}

// One tensor "t" of this description over four zero floats.
std::string OneTensor(const std::string& description) {
  return FileBytes("{\"t\": " + description + "}", std::string(16, '\0'));
}

TEST(SafeTensors, BothTypesAndTheMetadataAreRead) {
  const std::string data =
      BytesOf<float>({1.5f, -2, 0.25f, 8}) +
      BytesOf<uint16_t>({0x3c00, 0xc000, 0x0001, 0x03ff, 0x7bff, 0x8000});  // 2^-24 and up to 65504
  const TemporaryFile file(FileBytes(
      R"({"__metadata__": {"card": "{}", "made": "by hand"},
          "half": {"dtype": "F16", "shape": [3, 1, 2], "data_offsets": [16, 28]},
          "full": {"dtype": "F32", "shape": [4], "data_offsets": [0, 16]}})",
      data));
  const SafeTensors read = ReadSafeTensors(file.Path());
  EXPECT_EQ(read.file, file.Path().string());
  EXPECT_EQ(read.metadata.at("card"), "{}");
  EXPECT_EQ(read.metadata.at("made"), "by hand");
  ASSERT_EQ(read.tensors.size(), 2u);
  EXPECT_THAT(read.tensors.at("full").shape, ElementsAre(4));
  EXPECT_THAT(read.tensors.at("full").values, ElementsAre(1.5f, -2, 0.25f, 8));
  EXPECT_THAT(read.tensors.at("half").shape, ElementsAre(3, 1, 2));
  EXPECT_THAT(read.tensors.at("half").values,
              ElementsAre(1, -2, std::ldexp(1.0f, -24), 1023 * std::ldexp(1.0f, -24), 65504, 0));
  EXPECT_TRUE(std::signbit(read.tensors.at("half").values.back()));
}

TEST(SafeTensors, ANumberHasNoAxes) {
  const TemporaryFile file(
      FileBytes(R"({"t": {"dtype": "F32", "shape": [], "data_offsets": [0, 4]}})", BytesOf<float>({3})));
  EXPECT_THAT(ReadSafeTensors(file.Path()).tensors.at("t").values, ElementsAre(3));
}

TEST(SafeTensors, FilesThatAreCutOffOrNoneAreRefused) {
  EXPECT_THAT(ErrorOf([] { ReadSafeTensors("nowhere.safetensors"); }), HasSubstr("cannot be read"));
  EXPECT_THAT(ErrorOf([] { ReadSafeTensors(std::filesystem::temp_directory_path()); }),
              HasSubstr("cannot be read"));
  EXPECT_THAT(Refusal(""), HasSubstr("is cut off: has 0 bytes"));
  EXPECT_THAT(Refusal(LengthBytes(100) + "{}"),
              HasSubstr("its header has 100 bytes, and the file ends after 2"));
  EXPECT_THAT(Refusal(LengthBytes(~0ull) + "{}"), HasSubstr("is no safetensors file"));
  const std::string good = OneTensor(R"({"dtype": "F32", "shape": [4], "data_offsets": [0, 16]})");
  for (size_t bytes = 0; bytes < good.size(); ++bytes) Refusal(good.substr(0, bytes));
}

TEST(SafeTensors, HeadersThatSaySomethingElseAreRefused) {
  EXPECT_THAT(Refusal(FileBytes("{", "")), HasSubstr("its header is no JSON"));
  EXPECT_THAT(Refusal(FileBytes("[]", "")), HasSubstr("no JSON object"));
  EXPECT_THAT(Refusal(FileBytes(std::string(100000, '['), "")), HasSubstr("nested deeper"));
  EXPECT_THAT(Refusal(FileBytes(R"({"t": 1, "t": 2})", "")), HasSubstr("names t twice"));
  EXPECT_THAT(Refusal(FileBytes(R"({"__metadata__": {"a": 1}})", "")),
              HasSubstr("__metadata__'s a is no string"));
  EXPECT_THAT(Refusal(FileBytes(R"({"__metadata__": []})", "")), HasSubstr("__metadata__ is no JSON object"));
  EXPECT_THAT(Refusal(OneTensor("7")), HasSubstr("tensor t is described by something else"));
  EXPECT_THAT(Refusal(OneTensor(R"({"dtype": "F32", "shape": [4]})")), HasSubstr("tensor t is described by"));
}

TEST(SafeTensors, TensorsThatDoNotFitAreRefused) {
  const auto refusal = [](const std::string& dtype, const std::string& shape, const std::string& offsets) {
    return Refusal(OneTensor("{\"dtype\": \"" + dtype + "\", \"shape\": " + shape +
                             ", \"data_offsets\": " + offsets + "}"));
  };
  EXPECT_THAT(refusal("I64", "[2]", "[0, 16]"), HasSubstr("tensor t has dtype I64, must be F32 or F16"));
  EXPECT_THAT(refusal("BF16", "[8]", "[0, 16]"), HasSubstr("has dtype BF16"));
  EXPECT_THAT(refusal("F32", "[3]", "[0, 16]"), HasSubstr("has 16 bytes, and its shape [3] needs 12"));
  EXPECT_THAT(refusal("F32", "[0]", "[0, 16]"), HasSubstr("has shape [0], must be whole numbers >= 1"));
  EXPECT_THAT(refusal("F32", "[-4]", "[0, 16]"), HasSubstr("has shape [-4]"));
  EXPECT_THAT(refusal("F32", "4", "[0, 16]"), HasSubstr("a shape that is no array"));
  EXPECT_THAT(refusal("F32", "[4294967296, 4294967296]", "[0, 16]"), HasSubstr("more than the file holds"));
  EXPECT_THAT(refusal("F32", "[4]", "[16, 0]"), HasSubstr("the first must not be the larger"));
  EXPECT_THAT(refusal("F32", "[4]", "[0, 17]"),
              HasSubstr("ends at byte 17 of the data, of which the file has 16"));
  EXPECT_THAT(refusal("F32", "[4]", "[0]"), HasSubstr("not two whole numbers"));
  EXPECT_THAT(refusal("F32", "[4]", "[-1, 15]"), HasSubstr("not two whole numbers"));
  EXPECT_THAT(refusal("F32", "[3]", "[4, 16]"), HasSubstr("bytes 0 to 4 of its data belong to no tensor"));
  EXPECT_THAT(refusal("F32", "[3]", "[0, 12]"), HasSubstr("has 4 bytes after its last tensor"));
}

TEST(SafeTensors, TensorsThatOverlapAreRefused) {
  const std::string a = R"("a": {"dtype": "F32", "shape": [3], "data_offsets": [0, 12]})";
  const std::string b = R"("b": {"dtype": "F32", "shape": [2], "data_offsets": [8, 16]})";
  EXPECT_THAT(Refusal(FileBytes("{" + a + ", " + b + "}", std::string(16, '\0'))),
              HasSubstr("tensor b overlaps a"));
}

TEST(SafeTensors, WeightsThatAreNotFiniteAreRefused) {
  const std::string full = R"({"weight": {"dtype": "F32", "shape": [2], "data_offsets": [0, 8]}})";
  for (const float odd : {std::nanf(""), std::numeric_limits<float>::infinity()})
    EXPECT_THAT(Refusal(FileBytes(full, BytesOf<float>({1, odd}))),
                HasSubstr("tensor weight has a value that is not finite, at place 1"));
  const std::string half = R"({"weight": {"dtype": "F16", "shape": [2], "data_offsets": [0, 4]}})";
  for (const uint16_t odd : {0x7c00, 0xfc00, 0x7e00})
    EXPECT_THAT(Refusal(FileBytes(half, BytesOf<uint16_t>({odd, 1}))), HasSubstr("at place 0"));
}

}  // namespace
}  // namespace shimmer::restore
