// SPDX-License-Identifier: Apache-2.0
// A JSON value that knows its name, and checks its type and range as it is read: every complaint says which property of which file.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/gltf_strict.h"
#include "import/import.h"

namespace sunstone::gltf {

// Warnings of one import. A text is given once, with the first place and the number of the others, however many objects deserve it.
class Report {
 public:
  void warning(const std::string &place, const std::string &text);
  void once(const std::string &place, const std::string &text);  // the number of places is of no interest
  void flush(Notices &notices) const;

 private:
  struct Entry {
    std::string place, text;
    std::size_t count;
  };
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> by_text_;
  std::size_t beyond_ = 0;
};

// What every part of the importer needs to know.
struct Context {
  std::string file;  // its name, fit for messages
  std::filesystem::path folder;
  ImportOptions options;
  Report report;
  Notices &notices;
};

class Value {
 public:
  Value(Context &context, const Json *json, std::string place) : context_(&context), json_(json), place_(std::move(place)) {}

  explicit operator bool() const { return json_ != nullptr; }  // is it there?
  const Json &json() const { return *json_; }                  // only where it is
  const std::string &place() const { return place_; }
  Context &context() const { return *context_; }

  Value operator[](const char *key) const;                                                    // of an object; absent where this is absent
  Value operator[](std::size_t element) const;                                                // of an array that has so many
  Value operator[](int element) const { return (*this)[static_cast<std::size_t>(element)]; }  // or a literal 0 would be a null key
  std::size_t size() const;                                                                   // of an array; 0 where absent
  Value extension(const char *name) const;                                                    // an object in `extensions`, or absent

  // The value, or `otherwise` where it is absent. Another type, or a number that the result cannot hold, is an Error.
  std::string text(const char *otherwise = "") const;  // as it is: printable() before it is shown
  bool boolean(bool otherwise) const;
  double number(double otherwise) const;
  float real(float otherwise) const;
  float factor(float otherwise, float lower, float upper) const;  // clamped into the range, with a warning
  std::uint64_t whole(std::uint64_t otherwise) const;
  std::size_t index(std::size_t count, const char *what) const;  // has to be there and below count
  std::vector<double> numbers(std::size_t count) const;          // an array of exactly so many; empty where absent
  glm::vec2 vec2(glm::vec2 otherwise) const;
  glm::vec3 factors(glm::vec3 otherwise, float lower, float upper) const;
  void expect_object() const;

  // One warning for each extension of this object that is not among `known`.
  void check_extensions(std::initializer_list<const char *> known) const;

  [[noreturn]] void fail(std::string reason, std::string hint = {}) const;
  void warn(const std::string &text) const;
  std::string full_place() const;  // "lamp.gltf: nodes[3].mesh"

 private:
  [[noreturn]] void wrong_type(const char *wanted) const;
  static float as_float(const Value &who, double value);

  Context *context_;
  const Json *json_;
  std::string place_;
};

// "7 meshes", "1 mesh": `what` is the plural.
std::string counted(std::size_t count, const char *what);

}  // namespace sunstone::gltf
