#include "sim/app/config/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// "POINTER: message"; "no error" for good JSON.
std::string ErrorOf(const std::string& text) {
  try {
    ReadJson(text);
    return "no error";
  } catch (const ConfigError& error) {
    return error.pointer() + ": " + error.what();
  }
}

std::string Nested(int levels, char open, char close) {
  return std::string(static_cast<size_t>(levels), open) + std::string(static_cast<size_t>(levels), close);
}

TEST(JsonReader, ReadsWhatJsonIs) {
  const Json json =
      ReadJson(R"( {"a": [1, -2, 0.5, true, false, null, "\u00e9\n"], "b": {"c": {}}, "": []} )");
  EXPECT_EQ(json, (Json{{"a", {1, -2, 0.5, true, false, nullptr, "é\n"}},
                        {"b", {{"c", Json::object()}}},
                        {"", Json::array()}}));
  EXPECT_EQ(ReadJson("3"), 3);
  EXPECT_EQ(ReadJson("\xEF\xBB\xBF[]"), Json::array());  // a byte-order mark, as some editors write it
}

TEST(JsonReader, KeepsKindsOfNumbers) {
  EXPECT_TRUE(ReadJson("5").is_number_unsigned());
  EXPECT_TRUE(ReadJson("-5").is_number_integer());
  EXPECT_TRUE(ReadJson("5.0").is_number_float());
  EXPECT_TRUE(ReadJson("5e0").is_number_float());
  EXPECT_EQ(ReadJson("18446744073709551615").get<uint64_t>(), UINT64_MAX);
  EXPECT_EQ(ReadJson("-9223372036854775808").get<int64_t>(), INT64_MIN);
}

TEST(JsonReader, RefusesNumbersThatNoTypeHolds) {
  EXPECT_THAT(ErrorOf(R"({"a": [0, 18446744073709551616]})"), StartsWith("/a/1: is 18446744073709551616, "));
  EXPECT_THAT(ErrorOf("-9223372036854775809"), StartsWith(": is -9223372036854775809, "));
  EXPECT_EQ(ErrorOf(R"({"a": {"b": 1e999}})"), "/a/b: is 1e999, too large for a number");
  EXPECT_EQ(ErrorOf("[-1e999]"), "/0: is -1e999, too large for a number");
  EXPECT_THAT(ErrorOf("[" + std::string(100000, '9') + "]"), StartsWith("/0: is 9999"));
}

TEST(JsonReader, RefusesKeysThatAreThereTwice) {
  EXPECT_EQ(ErrorOf(R"({"a": 1, "b": {"c/d": 1, "e": [], "c/d": 1}})"),
            "/b/c~1d: key 'c/d' is there twice; must be there once");
  EXPECT_EQ(ErrorOf(R"([{}, {"a": 1, "\u0061": 2}])"), "/1/a: key 'a' is there twice; must be there once");
  EXPECT_EQ(ErrorOf(R"([{"a": 1}, {"a": 1}])"), "no error");
}

TEST(JsonReader, RefusesDeepNesting) {
  EXPECT_EQ(ErrorOf(Nested(kMaxJsonNesting, '[', ']')), "no error");
  EXPECT_THAT(ErrorOf(Nested(kMaxJsonNesting + 1, '[', ']')),
              HasSubstr("/0/0: is nested deeper than 64 levels"));
  EXPECT_THAT(ErrorOf(Nested(100000, '[', ']')), HasSubstr("is nested deeper than 64 levels"));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += R"({"a":)";
  EXPECT_THAT(ErrorOf(objects), HasSubstr("/a/a: is nested deeper than 64 levels"));
}

TEST(JsonReader, SaysLineAndColumnOfSyntaxErrors) {
  EXPECT_THAT(ErrorOf("{\n  \"a\": 1,\n}"), StartsWith(": line 3, column 1: "));
  EXPECT_THAT(ErrorOf("{\"a\": NaN}"), StartsWith(": line 1, column 7: "));
  EXPECT_THAT(ErrorOf("{\"a\": 1} x"), StartsWith(": line 1, column 10: "));
  EXPECT_THAT(ErrorOf("{\"a\": 1}\n{}"), StartsWith(": line 2, column 1: "));
  EXPECT_THAT(ErrorOf("{\"a\": 1"), HasSubstr("unexpected end of input"));
  EXPECT_THAT(ErrorOf("{'a': 1}"), StartsWith(": line 1, column 2: "));
  EXPECT_THAT(ErrorOf("[\"\xff\"]"), HasSubstr("ill-formed UTF-8"));
  EXPECT_THAT(ErrorOf("[Infinity]"), StartsWith(": line 1, column 2: "));
  EXPECT_THAT(ErrorOf("[01]"), StartsWith(": line 1, column 3: "));
}

TEST(JsonReader, HasNoComments) {
  EXPECT_EQ(ErrorOf("{\n \"a\": 1, // one\n}"), ": line 2, column 10: JSON has no comments");
  EXPECT_THAT(ErrorOf("/* one */ {}"), HasSubstr("JSON has no comments"));
  EXPECT_EQ(ReadJson("\"http://a\""), "http://a");
}

TEST(JsonReader, RefusesOtherEncodingsAndNothing) {
  EXPECT_EQ(ErrorOf(""), ": is empty, must be JSON");
  EXPECT_EQ(ErrorOf(" \r\n\t"), ": is empty, must be JSON");
  EXPECT_THAT(ErrorOf("\xEF\xBB\xBF"), StartsWith(": "));
  EXPECT_EQ(ErrorOf(std::string("\xFF\xFE{\0}\0", 6)), ": is UTF-16 text, must be UTF-8");
  EXPECT_EQ(ErrorOf(std::string("\xFE\xFF\0{\0}", 6)), ": is UTF-16 text, must be UTF-8");
  EXPECT_THAT(ErrorOf(std::string("{\0}\0", 4)), StartsWith(": line 1, column 2: a NUL byte"));
  EXPECT_THAT(ErrorOf(std::string("{}\n\0garbage", 11)), StartsWith(": line 2, column 1: a NUL byte"));
  EXPECT_THAT(ErrorOf(std::string(1, '\0')), StartsWith(": line 1, column 1: a NUL byte"));
}

TEST(JsonReader, MessagesAreOneShortLine) {
  const std::string long_line(1000000, 'x');
  const std::vector<std::string> bads = {"{\"" + long_line,
                                         "{\"a\\n\": 1, \"a\\n\": 1}",
                                         "[\"" + long_line + "\n\"]",
                                         "{\"" + long_line + "\": 1e999}",
                                         "{\"" + long_line + "\": 1, \"" + long_line + "\": 1}",
                                         "[\"\\u0000\n\"]",
                                         long_line,
                                         "[\"\\ud800\"]"};
  for (const std::string& bad : bads) {
    const std::string error = ErrorOf(bad);
    EXPECT_NE(error, "no error") << bad.substr(0, 40);
    EXPECT_LT(error.size(), 300u) << error.substr(0, 300);
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace shimmer::app
