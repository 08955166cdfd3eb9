// Whether a PNG file is whole, found before a decoder sees it: libpng reports damage on stderr by itself, and
// a library must not print.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace shimmer::dataset {

inline constexpr std::array<uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

bool LooksLikePng(std::span<const uint8_t> bytes);  // starts with the signature

// What is wrong with it: cut off, a checksum of a critical chunk, a header that no PNG has; nothing if it is
// whole.
std::optional<std::string> PngDamage(std::span<const uint8_t> bytes);

}  // namespace shimmer::dataset
