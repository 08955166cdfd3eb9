#include "sim/app/config/json_reader.h"

#include <algorithm>
#include <vector>

namespace shimmer::app {
namespace {

constexpr int kNumberOverflow = 406;  // nlohmann's id of the error

// Builds the value that the parser reports piece by piece, and knows at each piece where it is.
class Builder : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(const std::string& text) : text_(text) {}

  Json Take() { return std::move(root_); }

  bool null() override { return Add(nullptr); }
  bool boolean(bool value) override { return Add(value); }
  bool number_integer(int64_t value) override { return Add(value); }
  bool number_unsigned(uint64_t value) override { return Add(value); }
  bool number_float(double value, const std::string& literal) override {
    // A whole number that 64 bits can't hold arrives here as the nearest double.
    if (literal.find_first_of(".eE") == std::string::npos)
      throw ConfigError(NextPointer(),
                        "is " + ShownText(literal) +
                            ", whole numbers must be in [-9223372036854775808, 18446744073709551615]");
    return Add(value);
  }
  bool string(std::string& value) override { return Add(std::move(value)); }
  bool binary(Json::binary_t&) override { return false; }  // JSON text has none

  bool start_object(size_t) override { return Open(Json::object()); }
  bool end_object() override { return Close(); }
  bool start_array(size_t) override { return Open(Json::array()); }
  bool end_array() override { return Close(); }

  bool key(std::string& name) override {
    key_ = name;
    if (open_.back().value->contains(name))
      throw ConfigError(NextPointer(), "key '" + ShownText(name) + "' is there twice; must be there once");
    return true;
  }

  bool parse_error(size_t position, const std::string& token, const Json::exception& error) override {
    if (error.id == kNumberOverflow)
      throw ConfigError(NextPointer(), "is " + ShownText(token) + ", too large for a number");
    throw JsonSyntaxError("", Reason(position, error.what()));
  }

 private:
  struct Container {
    Json* value;
    std::string pointer;
  };

  // Of the value that comes next.
  std::string NextPointer() const {
    if (open_.empty()) return "";
    const Container& parent = open_.back();
    return parent.value->is_object() ? PointerUnder(parent.pointer, key_)
                                     : PointerUnder(parent.pointer, parent.value->size());
  }

  Json* Place(Json value) {
    if (open_.empty()) return &(root_ = std::move(value));
    Json& parent = *open_.back().value;
    if (parent.is_object()) return &(parent[key_] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  bool Add(Json value) {
    Place(std::move(value));
    return true;
  }

  bool Open(Json empty) {
    const std::string pointer = NextPointer();
    if (open_.size() == kMaxJsonNesting)
      throw ConfigError(pointer, "is nested deeper than " + std::to_string(kMaxJsonNesting) + " levels");
    open_.push_back({Place(std::move(empty)), pointer});
    return true;
  }

  bool Close() {
    open_.pop_back();
    return true;
  }

  // "line 2, column 7: unexpected '}'; expected string literal" from the parser's longer text, which repeats
  // all that it has read of a token, however long.
  std::string Reason(size_t position, const std::string& what) const {
    const size_t line = what.find("line ");
    std::string reason = line == std::string::npos ? what : what.substr(line);
    if (position > 0 && position <= text_.size() && text_[position - 1] == '/' &&
        reason.find("invalid literal") != std::string::npos)
      return reason.substr(0, reason.find(':')) + ": JSON has no comments";
    const size_t last_read = reason.find("; last read: ");
    if (last_read != std::string::npos) reason.resize(last_read);
    return reason;
  }

  const std::string& text_;
  Json root_;
  std::vector<Container> open_;  // outermost first; a container's own place does not move while it is open
  std::string key_;              // of the next value of the innermost object
};

void CheckEncoding(const std::string& text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw JsonSyntaxError("", "is UTF-16 text, must be UTF-8");
  const size_t nul = text.find('\0');  // the parser would take it for the end
  if (nul == std::string::npos) return;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
  const size_t column = nul == 0 ? 1 : nul - (text.rfind('\n', nul - 1) + 1) + 1;  // npos + 1 is 0
  throw JsonSyntaxError("", "line " + std::to_string(line) + ", column " + std::to_string(column) +
                                ": a NUL byte; must be UTF-8 text (is it UTF-16?)");
}

}  // namespace

Json ReadJson(const std::string& text) {
  CheckEncoding(text);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw JsonSyntaxError("", "is empty, must be JSON");
  Builder builder(text);
  Json::sax_parse(text, &builder);
  return builder.Take();
}

}  // namespace shimmer::app
