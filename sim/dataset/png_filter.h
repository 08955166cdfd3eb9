// What a PNG does to rows of samples before they are deflated. SIMD; the same bytes on every target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace shimmer::dataset {

// Filter 4 of the PNG specification, Paeth: each byte less the one of its left, upper and upper left
// neighbours that lies nearest to left + upper - upper left, modulo 256. pixel_bytes: how far away the left
// neighbour is, 1 to 8. above: the row before, zeros above the first; as long as row, as out is.
void PaethRow(std::span<const uint8_t> row, const uint8_t* above, size_t pixel_bytes, uint8_t* out);

// Samples of 16 bits with their high byte first: 2 row.size() bytes.
void BigEndianRow(std::span<const uint16_t> row, uint8_t* out);

}  // namespace shimmer::dataset
