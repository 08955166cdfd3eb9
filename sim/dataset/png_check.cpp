#include "sim/dataset/png_check.h"

#include <zlib.h>

#include <algorithm>

namespace shimmer::dataset {
namespace {

uint32_t BigEndian(std::span<const uint8_t> four) {
  return uint32_t{four[0]} << 24 | uint32_t{four[1]} << 16 | uint32_t{four[2]} << 8 | four[3];
}

// PNG specification, table 11.1: which bit depths each colour type may have.
bool DepthAllowed(int colour_type, int depth) {
  switch (colour_type) {
    case 0:
      return depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16;
    case 3:
      return depth == 1 || depth == 2 || depth == 4 || depth == 8;
    case 2:
    case 4:
    case 6:
      return depth == 8 || depth == 16;
    default:
      return false;
  }
}

std::optional<std::string> HeaderDamage(std::span<const uint8_t> data) {
  if (data.size() != 13) return "header of a wrong length";
  if (BigEndian(data) == 0 || BigEndian(data.subspan(4)) == 0) return "no width or height";
  if (!DepthAllowed(data[9], data[8])) return "header with an unknown colour type or bit depth";
  if (data[10] != 0 || data[11] != 0 || data[12] > 1)
    return "header with an unknown compression, filter or interlace";
  return {};
}

}  // namespace

bool LooksLikePng(std::span<const uint8_t> bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

std::optional<std::string> PngDamage(std::span<const uint8_t> bytes) {
  bytes = bytes.subspan(kPngSignature.size());
  bool header_seen = false, pixels_seen = false;
  // A chunk: length, type, data, checksum of type and data.
  while (bytes.size() >= 12) {
    const uint32_t length = BigEndian(bytes);
    const std::string type(reinterpret_cast<const char*>(bytes.data()) + 4, 4);
    if (length > bytes.size() - 12) return "cut off in the middle";
    const auto data = bytes.subspan(8, length);
    const bool critical = (bytes[4] & 0x20) == 0;
    const auto checksum = static_cast<uint32_t>(crc32_z(0, bytes.data() + 4, length + 4));
    if (critical && checksum != BigEndian(bytes.subspan(8 + length))) return "damaged (a checksum is wrong)";
    if (!header_seen) {
      if (type != "IHDR") return "no header";
      if (auto damage = HeaderDamage(data)) return damage;
      header_seen = true;
    }
    if (type == "IDAT") pixels_seen = true;
    if (type == "IEND") return pixels_seen ? std::nullopt : std::optional<std::string>("no pixels in it");
    bytes = bytes.subspan(12 + length);
  }
  return "cut off in the middle";
}

}  // namespace shimmer::dataset
