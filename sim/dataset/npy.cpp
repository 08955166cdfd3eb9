#include "sim/dataset/npy.h"

#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr int64_t kMostSide = 1 << 20;

struct Header {
  std::string text;  // a Python dictionary
  size_t bytes;      // with what stands before it
};

[[noreturn]] void Refuse(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

Header HeaderOf(const std::filesystem::path& path, const std::vector<uint8_t>& bytes) {
  if (bytes.size() < 12 || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    Refuse(path, "is no .npy file");
  const bool old = bytes[6] == 1;  // version 1 has 2 bytes of length, later ones 4
  const size_t start = old ? 10 : 12;
  size_t length = bytes[8] | size_t{bytes[9]} << 8;
  if (!old) length |= size_t{bytes[10]} << 16 | size_t{bytes[11]} << 24;
  if (bytes.size() - start < length) Refuse(path, "is cut off in its header");
  return {std::string(bytes.begin() + static_cast<ptrdiff_t>(start),
                      bytes.begin() + static_cast<ptrdiff_t>(start + length)),
          start + length};
}

// What stands behind 'key': in the dictionary.
std::string_view After(const std::filesystem::path& path, const std::string& text, const std::string& key) {
  const size_t at = text.find("'" + key + "':");
  if (at == std::string::npos) Refuse(path, "its header has no '" + key + "'");
  std::string_view rest = std::string_view(text).substr(at + key.size() + 3);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  return rest;
}

std::vector<int> ShapeOf(const std::filesystem::path& path, std::string_view text) {
  std::vector<int> shape;
  const size_t end = text.find(')');
  if (text.empty() || text[0] != '(' || end == std::string_view::npos) Refuse(path, "its shape is none");
  text = text.substr(1, end - 1);
  while (!text.empty()) {
    const size_t digit = text.find_first_of("0123456789");
    if (digit == std::string_view::npos) break;
    text.remove_prefix(digit);
    int64_t side = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || side < 1 || side > kMostSide)
      Refuse(path, "a side of its shape is out of range");
    shape.push_back(static_cast<int>(side));
    text.remove_prefix(static_cast<size_t>(stop - text.data()));
  }
  if (shape.size() == 2) shape.push_back(1);
  if (shape.size() != 3 || shape[2] > 4)
    Refuse(path, "must have 2 dimensions, or 3 of which the last is 1 to 4");
  return shape;
}

// Fortran's order: the row's number runs fastest, then the column's, then the channel's.
void PutColumnsFirst(const uint8_t* data, const std::vector<int>& shape, cv::Mat& array) {
  const size_t bytes = array.elemSize1();
  for (int channel = 0; channel < shape[2]; ++channel)
    for (int x = 0; x < shape[1]; ++x)
      for (int y = 0; y < shape[0]; ++y, data += bytes)
        std::memcpy(array.ptr(y, x) + static_cast<size_t>(channel) * bytes, data, bytes);
}

}  // namespace

cv::Mat ReadNpy(const std::filesystem::path& path) {
  const std::vector<uint8_t> bytes = ReadFile(path);
  const Header header = HeaderOf(path, bytes);
  const std::string_view kind = After(path, header.text, "descr").substr(0, 5);
  if (kind != "'<f4'" && kind != "'<f8'")
    Refuse(path, "is of " + std::string(kind) + ", must be '<f4' or '<f8'");
  const std::vector<int> shape = ShapeOf(path, After(path, header.text, "shape"));
  cv::Mat array(shape[0], shape[1], CV_MAKETYPE(kind == "'<f8'" ? CV_64F : CV_32F, shape[2]));
  const size_t wanted = array.total() * array.elemSize(), there = bytes.size() - header.bytes;
  if (there < wanted)
    Refuse(path, "is cut off: " + std::to_string(there) + " of " + std::to_string(wanted) + " bytes");
  const uint8_t* data = bytes.data() + header.bytes;
  if (After(path, header.text, "fortran_order").starts_with("True"))
    PutColumnsFirst(data, shape, array);
  else
    std::memcpy(array.data, data, wanted);
  return array;
}

}  // namespace shimmer::dataset
