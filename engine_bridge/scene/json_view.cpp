#include "engine_bridge/scene/json_view.h"

#include <fmt/format.h>

#include <cmath>

#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr std::size_t kMostNotes = 100;  // of one file

float clampNoted(double found, float low, float high, const std::string& where, Notes& notes) {
  if (found >= static_cast<double>(low) && found <= static_cast<double>(high)) return static_cast<float>(found);
  const float used = found < static_cast<double>(low) ? low : high;
  notes.add(fmt::format("{} is {:g}, outside {:g} to {:g}; {:g} is used", where, found, low, high, used));
  return used;
}

}  // namespace

std::string printable(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

void Notes::finish() {
  if (unsaid_ > 0) sentences_->push_back(fmt::format("{}: {} more notes are left out", file_, unsaid_));
  unsaid_ = 0;
}

void Notes::add(const std::string& sentence) {
  if (said_.contains(sentence)) return;
  if (said_.size() >= kMostNotes) {
    ++unsaid_;
    return;
  }
  said_.insert(sentence);
  sentences_->push_back(printable(file_ + ": " + sentence));
}

void JsonView::refuse(const std::string& rest) const {
  throw InputError(printable(fmt::format("{}: {} {}", *file_, where_.empty() ? "the document" : where_, rest)));
}

void JsonView::expectKind(bool matches, const char* kind) const {
  if (!matches) refuse(fmt::format("is {}; expected {}", value_->type_name(), kind));
}

std::optional<JsonView> JsonView::find(const char* key) const {
  expectKind(value_->is_object(), "an object");
  const auto member = value_->find(key);
  // Exporters write null for what they leave out, and viewers take it so.
  if (member == value_->end() || member->is_null()) return std::nullopt;
  return JsonView(*member, *file_, where_.empty() ? std::string(key) : where_ + "." + key);
}

JsonView JsonView::at(const char* key) const {
  std::optional<JsonView> member = find(key);
  if (!member) refuse(fmt::format("has no {}", key));
  return *member;
}

std::vector<std::string> JsonView::keys() const {
  expectKind(value_->is_object(), "an object");
  std::vector<std::string> names;
  for (const auto& item : value_->items()) names.push_back(item.key());
  return names;
}

std::string JsonView::scalarText() const {
  if (value_->is_string()) return value_->get<std::string>();
  return value_->is_number() || value_->is_boolean() ? value_->dump() : std::string();
}

std::size_t JsonView::size() const {
  expectKind(value_->is_array(), "an array");
  return value_->size();
}

JsonView JsonView::at(std::size_t index) const {
  if (index >= size()) refuse(fmt::format("has {} elements; expected more than {}", size(), index));
  return JsonView((*value_)[index], *file_, fmt::format("{}[{}]", where_, index));
}

double JsonView::number() const {
  expectKind(value_->is_number(), "a number");
  const double value = value_->get<double>();
  if (!std::isfinite(value)) refuse("is not finite; expected a finite number");
  return value;
}

bool JsonView::boolean() const {
  expectKind(value_->is_boolean(), "true or false");
  return value_->get<bool>();
}

const std::string& JsonView::string() const {
  expectKind(value_->is_string(), "a string");
  return value_->get_ref<const std::string&>();
}

std::size_t JsonView::unsignedInteger() const {
  constexpr double kExact = 9007199254740992.0;  // 2^53: some exporters write integers as 3.0
  const double value = number();
  if (value < 0.0 || value > kExact || value != std::floor(value)) {
    refuse(fmt::format("is {:g}; expected a whole number from 0 to 2^53", value));
  }
  return static_cast<std::size_t>(value);
}

std::vector<double> JsonView::numbers(std::size_t count) const {
  if (size() != count) refuse(fmt::format("has {} elements; expected {}", size(), count));
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = at(i).number();
  return values;
}

std::size_t JsonView::index(std::size_t count, const char* ofWhat) const {
  const std::size_t value = unsignedInteger();
  if (value >= count) refuse(fmt::format("is {}; expected an index below {}, the number of {}", value, count, ofWhat));
  return value;
}

float JsonView::number(const char* key, float fallback, float low, float high, Notes& notes) const {
  const std::optional<JsonView> member = find(key);
  return member ? clampNoted(member->number(), low, high, member->where(), notes) : fallback;
}

glm::vec3 JsonView::colour(const char* key, glm::vec3 fallback, float low, float high, Notes& notes) const {
  const std::optional<JsonView> member = find(key);
  if (!member) return fallback;
  const std::vector<double> v = member->numbers(3);
  const auto channel = [&](std::size_t i) { return clampNoted(v[i], low, high, member->where(), notes); };
  return {channel(0), channel(1), channel(2)};
}

glm::vec4 JsonView::colourAlpha(const char* key, glm::vec4 fallback, float low, float high, Notes& notes) const {
  const std::optional<JsonView> member = find(key);
  if (!member) return fallback;
  const std::vector<double> v = member->numbers(4);
  const auto channel = [&](std::size_t i) { return clampNoted(v[i], low, high, member->where(), notes); };
  return {channel(0), channel(1), channel(2), channel(3)};
}

bool JsonView::boolean(const char* key, bool fallback) const {
  const std::optional<JsonView> member = find(key);
  return member ? member->boolean() : fallback;
}

std::string JsonView::string(const char* key, const std::string& fallback) const {
  const std::optional<JsonView> member = find(key);
  return member ? member->string() : fallback;
}

std::size_t JsonView::unsignedInteger(const char* key, std::size_t fallback) const {
  const std::optional<JsonView> member = find(key);
  return member ? member->unsignedInteger() : fallback;
}

std::optional<JsonView> JsonView::extension(const char* name) const {
  const std::optional<JsonView> all = find("extensions");
  return all ? all->find(name) : std::nullopt;
}

}  // namespace pellucid::gltf
