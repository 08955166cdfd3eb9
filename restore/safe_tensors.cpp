#include "restore/safe_tensors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace shimmer::restore {
namespace {

using Json = nlohmann::json;
static_assert(std::endian::native == std::endian::little, "tensors are copied as they lie in the file");

constexpr uint64_t kLengthBytes = 8, kMostHeaderBytes = 16 << 20;
constexpr int kDepth = 3;  // of the header: its object, a tensor's, its shape

struct Place {  // of a tensor, in bytes after the header
  uint64_t begin, end;
  std::string name;
};

class Reader {
 public:
  Reader(std::string file, std::istream& stream) : file_(std::move(file)), stream_(stream) {
    stream_.seekg(0, std::ios::end);
    const std::streamoff size = stream_ ? static_cast<std::streamoff>(stream_.tellg()) : -1;
    if (size < 0 || std::filesystem::is_directory(file_)) Refuse("cannot be read");
    size_ = static_cast<uint64_t>(size);
  }

  SafeTensors Read() {
    const Json header = ReadHeader();
    SafeTensors read{.file = file_, .metadata = {}, .tensors = {}};
    std::vector<Place> places;
    for (const auto& [name, value] : header.items()) {
      if (name == "__metadata__")
        read.metadata = Metadata(value);
      else
        places.push_back(PlaceOf(name, value));
    }
    CheckPlaces(places);
    for (const Place& place : places)
      read.tensors.emplace(place.name, ReadTensor(place, header.at(place.name)));
    return read;
  }

 private:
  [[noreturn]] void Refuse(const std::string& what) const { throw std::runtime_error(file_ + ": " + what); }
  [[noreturn]] void Refuse(const std::string& tensor, const std::string& what) const {
    Refuse("tensor " + tensor + " " + what);
  }

  void ReadBytes(uint64_t at, uint64_t count, void* to) {
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
    if (!stream_) Refuse("cannot be read");
  }

  Json ReadHeader() {
    if (size_ < kLengthBytes)
      Refuse("is cut off: has " + std::to_string(size_) + " bytes, and 8 are the header's length alone");
    uint64_t length = 0;
    ReadBytes(0, kLengthBytes, &length);
    if (length > kMostHeaderBytes)
      Refuse("is no safetensors file: its header would have " + std::to_string(length) +
             " bytes, more than " + std::to_string(kMostHeaderBytes));
    if (length > size_ - kLengthBytes)
      Refuse("is cut off: its header has " + std::to_string(length) + " bytes, and the file ends after " +
             std::to_string(size_ - kLengthBytes) + " of them");
    data_ = kLengthBytes + length;
    std::string text(length, ' ');
    ReadBytes(kLengthBytes, length, text.data());
    std::set<std::string> names;
    const auto check = [&](int depth, Json::parse_event_t event, Json& value) {
      if (depth > kDepth) Refuse("its header is nested deeper than a safetensors file's");
      if (event == Json::parse_event_t::key && depth == 1 && !names.insert(value.get<std::string>()).second)
        Refuse("its header names " + value.get<std::string>() + " twice");
      return true;
    };
    Json header;
    try {
      header = Json::parse(text, check);
    } catch (const Json::exception& error) {
      Refuse(std::string("its header is no JSON: ") + error.what());
    }
    if (!header.is_object()) Refuse("its header is no JSON object");
    return header;
  }

  std::map<std::string, std::string> Metadata(const Json& value) const {
    std::map<std::string, std::string> texts;
    if (!value.is_object()) Refuse("__metadata__ is no JSON object");
    for (const auto& [key, text] : value.items()) {
      if (!text.is_string()) Refuse("__metadata__'s " + key + " is no string");
      texts[key] = text.get<std::string>();
    }
    return texts;
  }

  // Two bytes a number for F16, four for F32.
  uint64_t NumberBytes(const std::string& name, const Json& tensor) const {
    const std::string dtype = tensor.at("dtype").get<std::string>();
    if (dtype == "F32") return 4;
    if (dtype == "F16") return 2;
    Refuse(name, "has dtype " + dtype + ", must be F32 or F16");
  }

  Place PlaceOf(const std::string& name, const Json& tensor) const try {
    const uint64_t number_bytes = NumberBytes(name, tensor);
    const Json& offsets = tensor.at("data_offsets");
    const bool two = offsets.is_array() && offsets.size() == 2 && offsets[0].is_number_unsigned() &&
                     offsets[1].is_number_unsigned();
    if (!two) Refuse(name, "has data_offsets that are not two whole numbers >= 0");
    const Place place{offsets[0].get<uint64_t>(), offsets[1].get<uint64_t>(), name};
    const uint64_t available = size_ - data_;
    if (place.begin > place.end)
      Refuse(name, "has data_offsets " + offsets.dump() + ", of which the first must not be the larger");
    if (place.end > available)
      Refuse(name, "ends at byte " + std::to_string(place.end) + " of the data, of which the file has " +
                       std::to_string(available) + ": cut off?");
    const Json& shape = tensor.at("shape");
    if (!shape.is_array()) Refuse(name, "has a shape that is no array");
    const uint64_t most = available / number_bytes;
    uint64_t count = 1;
    for (const Json& axis : shape) {
      if (!axis.is_number_unsigned() || axis.get<uint64_t>() < 1)
        Refuse(name, "has shape " + shape.dump() + ", must be whole numbers >= 1");
      const uint64_t length = axis.get<uint64_t>();
      if (length > most / count) Refuse(name, "has shape " + shape.dump() + ", more than the file holds");
      count *= length;
    }
    if (place.end - place.begin != count * number_bytes)
      Refuse(name, "has " + std::to_string(place.end - place.begin) + " bytes, and its shape " +
                       shape.dump() + " needs " + std::to_string(count * number_bytes));
    return place;
  } catch (const Json::exception&) {
    Refuse(name, "is described by something else than a dtype, a shape and data_offsets");
  }

  void CheckPlaces(std::vector<Place>& places) const {
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.begin < b.begin; });
    uint64_t end = 0;
    for (size_t i = 0; i < places.size(); ++i) {
      if (places[i].begin < end) Refuse(places[i].name, "overlaps " + places[i - 1].name);
      if (places[i].begin > end)
        Refuse("bytes " + std::to_string(end) + " to " + std::to_string(places[i].begin) +
               " of its data belong to no tensor");
      end = places[i].end;
    }
    if (end != size_ - data_)
      Refuse("has " + std::to_string(size_ - data_ - end) + " bytes after its last tensor");
  }

  Tensor ReadTensor(const Place& place, const Json& described) {
    Tensor tensor{described.at("shape").get<std::vector<int64_t>>(), {}};
    const uint64_t bytes = place.end - place.begin;
    if (described.at("dtype") == "F32") {
      tensor.values.resize(bytes / 4);
      ReadBytes(data_ + place.begin, bytes, tensor.values.data());
    } else {
      std::vector<uint16_t> halves(bytes / 2);
      ReadBytes(data_ + place.begin, bytes, halves.data());
      tensor.values.reserve(halves.size());
      for (const uint16_t half : halves) tensor.values.push_back(FloatOf(half));
    }
    const auto odd = std::find_if_not(tensor.values.begin(), tensor.values.end(),
                                      [](float value) { return std::isfinite(value); });
    if (odd != tensor.values.end())
      Refuse(place.name,
             "has a value that is not finite, at place " + std::to_string(odd - tensor.values.begin()));
    return tensor;
  }

  // IEEE 754 binary16: sign, 5 bits of exponent, 10 of fraction.
  static float FloatOf(uint16_t half) {
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    const float size = exponent == 31  ? (fraction ? std::nanf("") : INFINITY)
                       : exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                       : std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
    return half & 0x8000 ? -size : size;
  }

  std::string file_;
  std::istream& stream_;
  uint64_t size_ = 0, data_ = 0;  // bytes of the file, and where its tensors begin
};

}  // namespace

std::string ShapeText(const std::vector<int64_t>& shape) {
  std::string text;
  for (const int64_t length : shape) text += (text.empty() ? "" : ", ") + std::to_string(length);
  return "[" + text + "]";
}

SafeTensors ReadSafeTensors(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Reader(file.string(), stream).Read();
}

SafeTensors ReadSafeTensors(const std::string& bytes, const std::string& name) {
  std::istringstream stream(bytes);
  return Reader(name, stream).Read();
}

}  // namespace shimmer::restore
