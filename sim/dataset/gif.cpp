// GIF89a: the format is small enough to write here; OpenImageIO's writer takes a palette a frame and
// speckles.
#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "sim/dataset/image_io.h"
#include "sim/dataset/palette.h"

namespace shimmer::dataset {
namespace {

using Bytes = std::vector<uint8_t>;

void Add(Bytes& bytes, std::string_view text) {
  for (const char c : text) bytes.push_back(static_cast<uint8_t>(c));
}

void AddTwo(Bytes& bytes, int value) {  // low byte first
  bytes.push_back(static_cast<uint8_t>(value & 255));
  bytes.push_back(static_cast<uint8_t>(value >> 8));
}

// Codes of growing width, packed from the lowest bit into blocks of at most 255 bytes.
class CodeBlocks {
 public:
  void Put(int code, int width_bits) {
    pending_ |= static_cast<uint32_t>(code) << pending_bits_;
    pending_bits_ += width_bits;
    for (; pending_bits_ >= 8; pending_bits_ -= 8, pending_ >>= 8) data_.push_back(pending_ & 255);
  }

  void AppendTo(Bytes& bytes) {
    if (pending_bits_ > 0) data_.push_back(pending_ & 255);
    for (size_t i = 0; i < data_.size(); i += 255) {
      const size_t size = std::min<size_t>(255, data_.size() - i);
      bytes.push_back(static_cast<uint8_t>(size));
      bytes.insert(bytes.end(), data_.begin() + i, data_.begin() + i + size);
    }
    bytes.push_back(0);
  }

 private:
  uint32_t pending_ = 0;
  int pending_bits_ = 0;
  Bytes data_;
};

// LZW with 8-bit symbols, as GIF89a, appendix F, has it.
void AddCompressed(Bytes& bytes, std::span<const uint8_t> symbols) {
  constexpr int kSymbolBits = 8, kClear = 256, kEnd = 257, kFirstFree = 258, kMostCodes = 4096;
  bytes.push_back(kSymbolBits);
  CodeBlocks blocks;
  std::vector<int16_t> next_of(kMostCodes * 256, -1);  // code of (known string, symbol); -1: not in the table
  int free = kFirstFree, width_bits = kSymbolBits + 1;
  blocks.Put(kClear, width_bits);
  int known = symbols[0];
  for (const uint8_t symbol : symbols.subspan(1)) {
    int16_t& next = next_of[known << 8 | symbol];
    if (next >= 0) {
      known = next;
      continue;
    }
    blocks.Put(known, width_bits);
    known = symbol;
    if (free < kMostCodes) {
      if (free == 1 << width_bits) ++width_bits;
      next = static_cast<int16_t>(free++);
    } else {
      blocks.Put(kClear, width_bits);
      std::ranges::fill(next_of, int16_t{-1});
      free = kFirstFree;
      width_bits = kSymbolBits + 1;
    }
  }
  blocks.Put(known, width_bits);
  if (free == 1 << width_bits && width_bits < 12) ++width_bits;
  blocks.Put(kEnd, width_bits);
  blocks.AppendTo(bytes);
}

}  // namespace

std::vector<uint8_t> EncodeGif(std::span<const cv::Mat> frames, int delay_ms) {
  if (frames.empty()) throw std::invalid_argument("an animation without frames");
  for (const cv::Mat& frame : frames)
    if (frame.empty() || frame.type() != CV_8UC3 || frame.size() != frames[0].size())
      throw std::invalid_argument("the frames of an animation must be 8-bit RGB of one size");
  const cv::Size size = frames[0].size();
  if (size.width > 65535 || size.height > 65535)
    throw std::invalid_argument("an animation over 65535 pixels a side");
  if (delay_ms < 10 || delay_ms > 655350) throw std::invalid_argument("delay_ms must be in [10, 655350]");

  const Palette palette = ChoosePalette(frames);
  Bytes bytes;
  Add(bytes, "GIF89a");
  AddTwo(bytes, size.width);
  AddTwo(bytes, size.height);
  Add(bytes, std::string_view("\xF7\0\0", 3));  // a palette of 256 colours, 8 bits each, follows
  for (const cv::Vec3b& colour : palette) bytes.insert(bytes.end(), colour.val, colour.val + 3);
  Add(bytes, std::string_view("\x21\xFF\x0BNETSCAPE2.0\x03\x01\0\0\0", 19));  // repeat for ever
  PaletteMapper mapper(palette);
  for (const cv::Mat& frame : frames) {
    Add(bytes, std::string_view("\x21\xF9\x04\x04", 4));  // the next frame is drawn over this one
    AddTwo(bytes, (delay_ms + 5) / 10);                   // hundredths of a second
    Add(bytes, std::string_view("\0\0\x2C\0\0\0\0", 7));  // frame at (0, 0)
    AddTwo(bytes, size.width);
    AddTwo(bytes, size.height);
    bytes.push_back(0);
    AddCompressed(bytes, mapper.Map(frame));
  }
  Add(bytes, ";");
  return bytes;
}

}  // namespace shimmer::dataset
