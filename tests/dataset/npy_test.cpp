#include "sim/dataset/npy.h"

#include <gtest/gtest.h>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

// As numpy writes it: the header padded to 64 bytes.
std::string Npy(const std::string& descr, const std::string& shape, const std::string& data, char version = 1,
                const std::string& order = "False") {
  std::string header = "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  const size_t start = version == 1 ? 10 : 12;
  while ((start + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string file = std::string("\x93NUMPY") + version + '\0';
  file += static_cast<char>(header.size() & 255);
  file += static_cast<char>(header.size() >> 8);
  if (version > 1) file += std::string(2, '\0');
  return file + header + data;
}

template <class T>
std::string Bytes(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

TEST(Npy, HoldsWhatNumpyPutIntoIt) {
  const TempFolder folder;
  const std::vector<double> numbers = {1, -2, 3.5, 4, 5, 6, 7, 8, 9, 10, 11, 1e-300};
  for (const char version : {char(1), char(2)}) {
    const cv::Mat field = ReadNpy(folder.Put("a.npy", Npy("<f8", "(3, 2, 2)", Bytes(numbers), version)));
    ASSERT_EQ(field.type(), CV_64FC2);
    ASSERT_EQ(field.size(), cv::Size(2, 3));
    EXPECT_EQ(field.at<cv::Vec2d>(0, 1), cv::Vec2d(3.5, 4));
    EXPECT_EQ(field.at<cv::Vec2d>(2, 1), cv::Vec2d(11, 1e-300));
  }
  const cv::Mat plain = ReadNpy(folder.Put("b.npy", Npy("<f4", "(1, 3)", Bytes<float>({1, 2, 3}))));
  ASSERT_EQ(plain.type(), CV_32FC1);
  EXPECT_EQ(plain.at<float>(0, 2), 3);
}

TEST(Npy, FortransOrderHasTheRowsRunFastest) {
  const TempFolder folder;
  const cv::Mat field = ReadNpy(folder.Put(
      "a.npy", Npy("<f4", "(3, 2, 2)", Bytes<float>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}), 1, "True")));
  EXPECT_EQ(field.at<cv::Vec2f>(0, 0), cv::Vec2f(1, 7));
  EXPECT_EQ(field.at<cv::Vec2f>(1, 0), cv::Vec2f(2, 8));
  EXPECT_EQ(field.at<cv::Vec2f>(0, 1), cv::Vec2f(4, 10));
  EXPECT_EQ(field.at<cv::Vec2f>(2, 1), cv::Vec2f(6, 12));
}

TEST(Npy, WhatIsNoneOrAnotherIsRefused) {
  const TempFolder folder;
  const std::string data(96, 'x');
  const std::pair<std::string, std::string> cases[] = {
      {"", "is no .npy file"},
      {"PK\3\4 a zip of arrays", "is no .npy file"},
      {Npy("<f8", "(3, 2, 2)", data).substr(0, 40), "cut off in its header"},
      {Npy("<f8", "(3, 2, 2)", data.substr(1)), "is cut off: 95 of 96 bytes"},
      {Npy("<i8", "(3, 2, 2)", data), "must be '<f4' or '<f8'"},
      {Npy(">f8", "(3, 2, 2)", data), "must be '<f4' or '<f8'"},
      {Npy("<f8", "(12,)", data), "must have 2 dimensions"},
      {Npy("<f8", "(1, 1, 1, 12)", data), "must have 2 dimensions"},
      {Npy("<f8", "(99999999999, 2)", data), "out of range"},
      {Npy("<f8", "(0, 2)", data), "out of range"}};
  for (const auto& [bytes, what] : cases) {
    const auto path = folder.Put("bad.npy", bytes);
    const std::string error = ErrorOf<std::runtime_error>([&] { ReadNpy(path); });
    EXPECT_TRUE(Contains(error, what)) << error << " for " << what;
    EXPECT_TRUE(Contains(error, "bad.npy") || bytes.empty()) << error;
  }
  EXPECT_THROW(ReadNpy(folder / "none.npy"), std::runtime_error);
}

}  // namespace
}  // namespace shimmer::dataset
