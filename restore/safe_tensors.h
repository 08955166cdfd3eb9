// Weights of a network in a file, as the safetensors format keeps them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shimmer::restore {

struct Tensor {
  std::vector<int64_t> shape;  // outermost first; none for a single number
  std::vector<float> values;   // the last axis innermost; finite
};

std::string ShapeText(const std::vector<int64_t>& shape);  // "[48, 16, 1, 1]"

// The file holds 8 bytes with the length of the header, lowest first, the header, JSON
//   {NAME: {"dtype": "F32", "shape": [48, 16], "data_offsets": [0, 3072]}, "__metadata__": {KEY: TEXT}},
// and the tensors' bytes, lowest first, without gaps (github.com/huggingface/safetensors, "Format").
struct SafeTensors {
  std::string file;  // for messages
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;
};

// Reads F32 and F16, which become floats. Takes memory of a few times the file's size at most, whatever the
// file says of itself.
//
// Throws std::runtime_error with the file and, where it is one's fault, the tensor: cannot be read, is cut
// off, has a header that is too long (over 16 MB) or says anything but the above, tensors that overlap, leave
// bytes between them or lie outside, another dtype, a size that is not the shape's, or a value that is not
// finite.
SafeTensors ReadSafeTensors(const std::filesystem::path& file);
// The same of a file's bytes, which messages call `name`.
SafeTensors ReadSafeTensors(const std::string& bytes, const std::string& name);

}  // namespace shimmer::restore
