// configs/schema.json: what editors and other programs can check of a config. Rules between keys, and
// that 8.0 is not the way to write a whole number, are ConfigFile's alone.
#include <algorithm>

#include "sim/app/config/config.h"
#include "sim/app/config/distribution.h"
#include "sim/app/config/keys.h"

namespace shimmer::app {
namespace {

using Schema = nlohmann::ordered_json;  // keys in the order of their writing

Schema ListOf(const Schema& items, size_t count) {
  return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

// low and high as the two given words of JSON Schema, where the key has them.
void AddRange(const Key& key, const char* low_word, const char* high_word, Schema& schema) {
  if (!key.low.is_null()) schema[low_word] = key.low;
  if (!key.high.is_null()) schema[high_word] = key.high;
}

Schema NumberSchema(const Key& key, const char* type) {
  Schema schema = {{"type", type}};
  AddRange(key, "minimum", "maximum", schema);
  for (const double value : key.field.values)
    schema["enum"].push_back(key.kind == Kind::kInteger ? Schema(static_cast<int64_t>(value))
                                                        : Schema(value));
  return schema;
}

Schema TextSchema(const Key& key) {
  Schema schema = {{"type", "string"}};
  AddRange(key, "minLength", "maxLength", schema);
  return schema;
}

// A list of texts, or one of them alone.
Schema TextsSchema(const Key& key) {
  const bool named = !key.field.names.empty();
  const Schema text =
      named ? Schema{{"enum", key.field.names}} : Schema{{"type", "string"}, {"minLength", 1}};
  Schema list = {{"type", "array"}, {"items", text}, {"uniqueItems", named}};
  AddRange(key, "minItems", "maxItems", list);
  return {{"oneOf", Schema::array({text, list})}};
}

Schema LiteralSchema(const Key& key) {
  switch (key.kind) {
    case Kind::kSection:
    case Kind::kList:
      break;
    case Kind::kPoints:
      return {{"type", "array"}, {"items", ListOf(NumberSchema(key, "number"), 2)}};
    case Kind::kReal:
      return NumberSchema(key, "number");
    case Kind::kInteger:
      return NumberSchema(key, "integer");
    case Kind::kFlag:
      return {{"type", "boolean"}};
    case Kind::kName:
      return {{"enum", key.field.names}};
    case Kind::kText:
      return TextSchema(key);
    case Kind::kTexts:
      return TextsSchema(key);
    case Kind::kSize:
      return ListOf(NumberSchema(key, "integer"), 2);
  }
  throw std::logic_error("LiteralSchema: a kind without a schema");
}

// What is common to all distributions; each key adds what its values may be.
Schema DistributionRules() {
  Schema one_of = Schema::array(), beside = Schema::object();
  for (const DistributionForm& form : kDistributionForms) {
    one_of.push_back({{"required", {form.name}}});
    if (*form.companion) beside[form.companion] = {form.name};
  }
  return {{"type", "object"}, {"oneOf", one_of}, {"dependentRequired", beside}};
}

Schema DistributionSchema(const Key& key, const Schema& literal) {
  Schema forms;
  if (DrawsNumbers(key)) {
    Schema positive = literal;
    positive["exclusiveMinimum"] = 0;
    forms[kUniform] = ListOf(literal, 2);
    forms[kLogUniform] = ListOf(positive, 2);
    forms[kNormal] = ListOf({{"type", "number"}}, 2);
    forms[kClip] = ListOf(literal, 2);
  }
  forms[kChoice] = {{"type", "array"}, {"items", literal}, {"minItems", 1}};
  forms[kWeights] = {{"type", "array"}, {"items", {{"type", "number"}, {"minimum", 0}}}, {"minItems", 1}};
  forms[kAs] = {{"type", "string"}, {"minLength", 1}};
  return {{"$ref", "#/$defs/distribution"}, {"additionalProperties", false}, {"properties", forms}};
}

// No default stands for such a section: one of the alternatives must be given.
bool HasAlternatives(const Key& section) {
  return std::any_of(section.keys.begin(), section.keys.end(),
                     [](const Key& k) { return k.field.alternative; });
}

Schema KeySchema(const Key& key);

void AddKeys(const Key& section, Schema& schema) {
  Schema required = Schema::array(), alternatives = Schema::array();
  for (const Key& key : section.keys) {
    schema["properties"][key.name()] = KeySchema(key);
    if (key.kind == Kind::kSection && HasAlternatives(key)) required.push_back(key.name());
    if (key.field.alternative) alternatives.push_back({{"required", {key.name()}}});
  }
  schema["additionalProperties"] = false;
  if (!required.empty()) schema["required"] = required;
  if (!alternatives.empty()) schema["oneOf"] = alternatives;
}

Schema KeySchema(const Key& key) {
  const std::string unit = key.field.unit;
  Schema schema = {{"description", key.field.help + (unit.empty() ? "" : " [" + unit + "]")}};
  if (key.kind == Kind::kSection) {
    schema["type"] = "object";
    AddKeys(key, schema);
    return schema;
  }
  if (!key.field.alternative) schema["default"] = key.fallback;
  if (key.kind == Kind::kList) {
    schema["type"] = "array";
    schema["maxItems"] = key.high;
    schema["items"]["type"] = "object";
    AddKeys(key, schema["items"]);
    return schema;
  }
  const Schema literal = LiteralSchema(key);
  if (key.field.per_clip)
    schema["oneOf"] = Schema::array({literal, DistributionSchema(key, literal)});
  else
    schema.update(literal);
  return schema;
}

}  // namespace

std::string SchemaText() {
  Schema schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Shimmer config"}};
  schema.update(KeySchema(AllKeys()));
  schema["$defs"]["distribution"] = DistributionRules();
  return schema.dump(2) + "\n";
}

}  // namespace shimmer::app
