// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_value.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace sunstone::gltf {

namespace {
constexpr std::size_t max_warnings = 200;  // distinct ones; a file can hold a hundred thousand names

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}
}  // namespace

void Report::warning(const std::string &place, const std::string &text) {
  if (const auto found = by_text_.find(text); found != by_text_.end()) {
    entries_[found->second].count++;
  } else if (entries_.size() < max_warnings) {
    by_text_.emplace(text, entries_.size());
    entries_.push_back({place, text, 1});
  } else {
    beyond_++;
  }
}

void Report::once(const std::string &place, const std::string &text) {
  if (!by_text_.contains(text)) warning(place, text);
}

void Report::flush(Notices &notices) const {
  for (const Entry &entry : entries_)
    notices.warning(entry.place, entry.count == 1 ? entry.text : entry.text + " (the first of " + std::to_string(entry.count) + ")");
  if (beyond_ > 0) notices.warning(entries_.front().place, "and " + std::to_string(beyond_) + " more warnings");
}

std::string counted(std::size_t count, const char *what) {
  std::string name = what;
  if (count == 1) {
    if (name == "meshes")
      name = "mesh";
    else if (name == "vertices")
      name = "vertex";
    else if (name.ends_with('s'))
      name.pop_back();
  }
  return std::to_string(count) + " " + name;
}

std::string Value::full_place() const { return place_.empty() ? context_->file : context_->file + ": " + place_; }
void Value::fail(std::string reason, std::string hint) const { throw Error(full_place(), std::move(reason), std::move(hint)); }
void Value::warn(const std::string &text) const { context_->report.warning(full_place(), text); }

void Value::wrong_type(const char *wanted) const {
  const std::string type = json_->type_name();
  fail("has to be " + std::string(wanted) + ", not " + (type == "object" || type == "array" ? "an " : type == "null" ? "" : "a ") + type);
}

void Value::expect_object() const {
  if (!json_) fail("is missing");
  if (!json_->is_object()) wrong_type("an object");
}

Value Value::operator[](const char *key) const {
  std::string place = place_.empty() ? key : place_ + "." + key;
  if (!json_) return {*context_, nullptr, std::move(place)};
  if (!json_->is_object()) wrong_type("an object");
  const auto found = json_->find(key);
  return {*context_, found == json_->end() ? nullptr : &*found, std::move(place)};
}

std::size_t Value::size() const {
  if (!json_) return 0;
  if (!json_->is_array()) wrong_type("an array");
  return json_->size();
}

Value Value::operator[](std::size_t element) const {
  std::string place = place_ + "[" + std::to_string(element) + "]";
  if (element >= size()) throw Error(context_->file + ": " + place, "is missing");
  return {*context_, &(*json_)[element], std::move(place)};
}

Value Value::extension(const char *name) const {
  const Value found = (*this)["extensions"][name];
  if (found) found.expect_object();
  return found;
}

std::string Value::text(const char *otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_string()) wrong_type("a string");
  return json_->get_ref<const std::string &>();
}

bool Value::boolean(bool otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_boolean()) wrong_type("true or false");
  return json_->get<bool>();
}

double Value::number(double otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_number()) wrong_type("a number");
  return json_->get<double>();
}

float Value::as_float(const Value &who, double value) {
  if (std::fabs(value) > static_cast<double>(std::numeric_limits<float>::max())) who.fail(shown(value) + " is beyond single precision");
  return static_cast<float>(value);
}

float Value::real(float otherwise) const { return json_ ? as_float(*this, number(0)) : otherwise; }

float Value::factor(float otherwise, float lower, float upper) const {
  const float value = real(otherwise);
  if (value >= lower && value <= upper) return value;
  warn(shown(value) + " is " + (value < lower ? "less than " + shown(lower) : "more than " + shown(upper)) + " and was clamped");
  return std::clamp(value, lower, upper);
}

std::uint64_t Value::whole(std::uint64_t otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_number()) wrong_type("a whole number");
  if (json_->is_number_unsigned()) return json_->get<std::uint64_t>();
  const double value = json_->get<double>();  // "3.0" is a whole number, too
  if (!(value >= 0)) fail(shown(value) + " is negative");
  if (value != std::floor(value) || value > 9007199254740992.0) fail(shown(value) + " is no whole number");
  return static_cast<std::uint64_t>(value);
}

std::size_t Value::index(std::size_t count, const char *what) const {
  if (!json_) fail("is missing");
  const std::uint64_t value = whole(0);
  if (value >= count) fail("index " + std::to_string(value) + ", but there " + (count == 1 ? "is " : "are ") + counted(count, what));
  return static_cast<std::size_t>(value);
}

std::vector<double> Value::numbers(std::size_t count) const {
  if (!json_) return {};
  if (size() != count) fail("has " + counted(size(), "numbers") + " instead of " + std::to_string(count));
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; i++) values[i] = (*this)[i].number(0);
  return values;
}

glm::vec2 Value::vec2(glm::vec2 otherwise) const {
  if (!json_) return otherwise;
  numbers(2);
  return {(*this)[0].real(0), (*this)[1].real(0)};
}

glm::vec3 Value::factors(glm::vec3 otherwise, float lower, float upper) const {
  if (!json_) return otherwise;
  numbers(3);
  return {(*this)[0].factor(0, lower, upper), (*this)[1].factor(0, lower, upper), (*this)[2].factor(0, lower, upper)};
}

void Value::check_extensions(std::initializer_list<const char *> known) const {
  const Value extensions = (*this)["extensions"];
  if (!extensions) return;
  extensions.expect_object();
  for (const auto &[name, value] : extensions.json().items()) {
    if (std::any_of(known.begin(), known.end(), [&](const char *other) { return name == other; })) continue;
    if (name == "KHR_xmp_json_ld" || name == "KHR_xmp") continue;  // words about the file, nothing to render
    const std::string shown_name = printable(name);
    // The place is the file alone: the point is the extension, not which of its many objects came first.
    if (name.starts_with("KHR_materials_"))
      context_->report.once(context_->file, shown_name + " is not rendered");
    else
      context_->report.once(context_->file, "the extension " + shown_name + " is not supported and was ignored");
  }
}

}  // namespace sunstone::gltf
