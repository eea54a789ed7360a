// JSON that is not trusted: every access checks type, presence and range, and names the place in the file.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pellucid::gltf {

// On one line: names and libraries' messages may hold anything, a message is one sentence on one line.
std::string printable(std::string text);

// One sentence each, prefixed with the file's path; the same sentence once. After many distinct ones the rest is only
// counted, in a last sentence added by finish(): a broken file must not bury what matters.
class Notes {
 public:
  Notes(std::string file, std::vector<std::string>& sentences) : file_(std::move(file)), sentences_(&sentences) {}
  Notes(const Notes&) = delete;
  Notes& operator=(const Notes&) = delete;
  void add(const std::string& sentence);
  void finish();

 private:
  std::string file_;
  std::vector<std::string>* sentences_;
  std::set<std::string> said_;
  std::size_t unsaid_ = 0;
};

// A value of the document and where it stands. Cheap to copy; the document and the file name outlive it.
class JsonView {
 public:
  JsonView(const nlohmann::json& value, const std::string& file, std::string where)
      : value_(&value), file_(&file), where_(std::move(where)) {}

  const std::string& where() const { return where_; }

  // Members of an object. `find` is empty when the member is absent.
  std::optional<JsonView> find(const char* key) const;
  JsonView at(const char* key) const;
  std::vector<std::string> keys() const;

  bool isObject() const { return value_->is_object(); }
  // A number, string or boolean as --set would have it written; empty for anything else.
  std::string scalarText() const;

  // Elements of an array.
  std::size_t size() const;
  JsonView at(std::size_t index) const;

  // The value itself; InputError when it is of another kind.
  double number() const;
  bool boolean() const;
  const std::string& string() const;
  std::size_t unsignedInteger() const;
  std::vector<double> numbers(std::size_t count) const;
  // An index into something that has `count` elements.
  std::size_t index(std::size_t count, const char* ofWhat) const;

  // Optional members. Numbers outside [low, high] are clamped, which is noted.
  float number(const char* key, float fallback, float low, float high, Notes& notes) const;
  glm::vec3 colour(const char* key, glm::vec3 fallback, float low, float high, Notes& notes) const;
  glm::vec4 colourAlpha(const char* key, glm::vec4 fallback, float low, float high, Notes& notes) const;
  bool boolean(const char* key, bool fallback) const;
  std::string string(const char* key, const std::string& fallback) const;
  std::size_t unsignedInteger(const char* key, std::size_t fallback) const;
  std::optional<JsonView> extension(const char* name) const;  // extensions.NAME

  // Throws InputError: "FILE: WHERE " followed by the rest of the sentence.
  [[noreturn]] void refuse(const std::string& rest) const;

 private:
  void expectKind(bool matches, const char* kind) const;
  const nlohmann::json* value_;
  const std::string* file_;
  std::string where_;
};

}  // namespace pellucid::gltf
