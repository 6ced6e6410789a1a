// SPDX-License-Identifier: Apache-2.0
#include "import/obj_guard.h"

#include <array>
#include <charconv>

#include "base/error.h"

namespace sunstone {

namespace {

enum class Statement {
  position,
  texture_coordinate,
  normal,
  face,
  line_or_point,
  free_form,
  material,
  library,
  smoothing,
  command,
  ignored,
  unknown
};

Statement statement(std::string_view word) {
  static const std::map<std::string_view, Statement> known = [] {
    std::map<std::string_view, Statement> m{
        {"v", Statement::position},      {"vt", Statement::texture_coordinate}, {"vn", Statement::normal},       {"f", Statement::face},
        {"fo", Statement::face},         {"l", Statement::line_or_point},       {"p", Statement::line_or_point}, {"curv", Statement::free_form},
        {"curv2", Statement::free_form}, {"surf", Statement::free_form},        {"usemtl", Statement::material}, {"mtllib", Statement::library},
        {"s", Statement::smoothing},     {"csh", Statement::command},           {"call", Statement::command}};
    for (const char *word : {"g",         "o",     "t",     "vp",     "vw",     "deg", "bmat",  "step", "cstype",   "parm",     "trim",
                             "hole",      "scrv",  "sp",    "end",    "con",    "mg",  "bevel", "lod",  "c_interp", "d_interp", "shadow_obj",
                             "trace_obj", "ctech", "stech", "maplib", "usemap", "bsp", "bzp",   "cdc",  "cdp",      "res"})
      m[word] = Statement::ignored;
    return m;
  }();
  if (word == "v") return Statement::position;  // nearly every line is one of these two
  if (word == "f") return Statement::face;
  const auto found = known.find(word);
  return found == known.end() ? Statement::unknown : found->second;
}

struct Corner {
  std::int64_t position = 0, texture_coordinate = 0, normal = 0;  // from 1; 0: none
};

class Guard {
 public:
  Guard(const ObjSurvey &survey, const std::map<std::string, int> &materials, LineFaults &faults)
      : survey_(survey), materials_(materials), faults_(faults), bad_positions_(survey.positions + 1), bad_normals_(survey.normals + 1) {}

  GuardedObj run(std::string_view text) {
    out_.text.reserve(text.size() + text.size() / 8);
    out_.corners.reserve(survey_.faces);
    text_ = text;
    LineReader reader(text);
    for (std::string_view line; reader.next(line, line_number_);) {
      std::string_view rest = line;
      const std::string_view word = take_word(rest);
      switch (statement(word)) {
        case Statement::position:
          position(rest);
          break;
        case Statement::texture_coordinate:
          texture_coordinate(rest);
          break;
        case Statement::normal:
          normal(rest);
          break;
        case Statement::face:
          face(without_comment(rest));
          break;
        case Statement::material:
          material(trim(rest));
          break;
        case Statement::smoothing:
          smoothing(without_comment(rest));
          break;
        case Statement::command:
          fault("\"csh\" and \"call\" are never run");
          break;
        case Statement::line_or_point:
          fault("lines and points are not rendered");
          break;
        case Statement::free_form:
          fault("free-form curves and surfaces are not rendered");
          break;
        case Statement::unknown:
          fault("not a statement of OBJ: ignored");
          break;
        case Statement::library:
        case Statement::ignored:
          break;
      }
    }
    return std::move(out_);
  }

 private:
  void fault(const std::string &what) { faults_.add(what, line_number_); }

  // A face that comes before its vertices has to know now which of them are usable: the rare file that does so is read once more.
  void look_ahead() {
    if (looked_ahead_) return;
    looked_ahead_ = true;
    LineReader reader(text_);
    std::size_t positions = 0, normals = 0, number = 0;
    for (std::string_view line; reader.next(line, number);) {
      if (line[0] != 'v') continue;
      std::string_view rest = line;
      const Statement kind = statement(take_word(rest));
      if (kind == Statement::position) bad_positions_[++positions] = numbers(rest) < 3;
      if (kind == Statement::normal) bad_normals_[++normals] = numbers(rest) < 3;
    }
  }

  bool bad(const std::vector<bool> &list, std::int64_t index, std::size_t so_far) {
    if (index > static_cast<std::int64_t>(so_far)) look_ahead();
    return list[index];
  }

  // How many numbers stand in a row at the beginning of `rest`; -1 where something else than a comment follows them.
  int numbers(std::string_view rest) {
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#'; word = take_word(rest)) {
      const std::optional<float> value = parse_number(word);
      if (!value) return -1;
      if (count < 8) words_[count] = *value == 0 ? "0" : word;  // (the loader makes NaN of 0e500)
      count++;
    }
    return count;
  }

  void write(const char *keyword, std::initializer_list<std::string_view> words) {
    out_.text += keyword;
    for (const std::string_view word : words) (out_.text += ' ') += word;
    out_.text += '\n';
  }

  void position(std::string_view rest) {
    const int count = numbers(rest);
    bad_positions_[++positions_] = count < 3;
    if (count < 3) {
      fault("a vertex that is not three finite numbers: faces that use it are dropped");
      write("v", {"0", "0", "0"});
    } else if (count == 6 || count == 7) {  // x y z [w] r g b
      out_.has_colors = true;
      write("v", {words_[0], words_[1], words_[2], words_[count - 3], words_[count - 2], words_[count - 1]});
    } else {
      write("v", {words_[0], words_[1], words_[2]});
    }
  }

  void texture_coordinate(std::string_view rest) {
    const int count = numbers(rest);
    texture_coordinates_++;
    if (count < 1) fault("a texture coordinate that is not finite numbers: taken as 0");
    write("vt", {count < 1 ? "0" : words_[0], count < 2 ? "0" : words_[1]});
  }

  void normal(std::string_view rest) {
    const bool good = numbers(rest) >= 3;
    bad_normals_[++normals_] = !good;
    if (!good) fault("a normal that is not three finite numbers: not used");
    write("vn", {good ? words_[0] : "0", good ? words_[1] : "0", good ? words_[2] : "0"});
  }

  // An index as the file has it, made absolute. False where it is no index at all.
  static bool parse_index(std::string_view word, std::size_t so_far, std::int64_t &index) {
    const std::optional<std::int64_t> value = parse_integer(word);
    if (!value || *value == INT64_MIN) return false;
    index = *value < 0 ? static_cast<std::int64_t>(so_far) + *value + 1 : *value;
    if (*value < 0 && index <= 0) index = -1;
    return true;
  }

  // v, v/vt, v//vn, v/vt/vn; what follows a slash may be empty.
  bool parse_corner(std::string_view word, Corner &corner, const char *&reason) {
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::size_t begin = 0; begin <= word.size(); count++) {
      const std::size_t slash = std::min(word.find('/', begin), word.size());
      if (count == 3) {
        reason = "a face with more than three indices a corner: dropped";
        return false;
      }
      parts[count] = word.substr(begin, slash - begin);
      begin = slash + 1;
    }
    reason = "a face with a corner that is not made of whole numbers: dropped";
    if (!parse_index(parts[0], positions_, corner.position)) return false;
    if (count > 1 && !parts[1].empty() && !parse_index(parts[1], texture_coordinates_, corner.texture_coordinate)) return false;
    if (count > 2 && !parts[2].empty() && !parse_index(parts[2], normals_, corner.normal)) return false;
    if (corner.position == 0)
      reason = "a face with the index 0 (they begin at 1): dropped";
    else if (corner.position < 0 || corner.position > static_cast<std::int64_t>(survey_.positions))
      reason = "a face with an index beyond the vertices: dropped";
    else if (bad(bad_positions_, corner.position, positions_))
      reason = "a face with a vertex that is not three finite numbers: dropped";
    else
      return true;
    return false;
  }

  void face(std::string_view rest) {
    corners_.clear();
    bool no_coordinate = false, no_normal = false;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      Corner corner;
      const char *reason = nullptr;
      if (!parse_corner(word, corner, reason)) return fault(reason);
      const bool given_coordinate = word.find('/') != word.npos && corner.texture_coordinate != 0, given_normal = corner.normal != 0;
      if (given_coordinate && (corner.texture_coordinate < 0 || corner.texture_coordinate > static_cast<std::int64_t>(survey_.texture_coordinates))) {
        no_coordinate = true;
        corner.texture_coordinate = 0;
      }
      if (given_normal && (corner.normal < 0 || corner.normal > static_cast<std::int64_t>(survey_.normals))) {
        no_normal = true;
        corner.normal = 0;
      } else if (given_normal && bad(bad_normals_, corner.normal, normals_)) {
        corner.normal = 0;
      }
      corners_.push_back(corner);
    }
    if (corners_.size() < 3) return fault("a face of fewer than three corners: dropped");
    if (no_coordinate) fault("a face with an index beyond the texture coordinates: rendered without them");
    if (no_normal) fault("a face with an index beyond the normals: rendered without them");
    out_.text += 'f';
    for (const Corner &corner : corners_) {
      out_.text += ' ';
      append(corner.position);
      if (corner.texture_coordinate || corner.normal) out_.text += '/';
      if (corner.texture_coordinate) append(corner.texture_coordinate);
      if (corner.normal) {
        out_.text += '/';
        append(corner.normal);
      }
    }
    out_.text += '\n';
    out_.corners.push_back(static_cast<std::uint32_t>(corners_.size()));
  }

  void append(std::int64_t value) {
    char digits[24];
    out_.text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }

  void material(std::string_view name) {
    auto found = materials_.find(std::string(name));
    if (found == materials_.end()) found = materials_.find(std::string(take_word(name)));
    if (found != materials_.end()) {
      out_.text += "usemtl ";
      append(found->second);
      out_.text += '\n';
    } else {
      out_.text += "usemtl none\n";
      fault("a material that is in no library: the default material is used");
    }
  }

  void smoothing(std::string_view rest) {
    const std::string_view word = take_word(rest);
    const std::optional<std::int64_t> group = word == "off" ? 0 : word == "on" ? 1 : parse_integer(word);
    const bool good = group && *group >= 0 && *group <= 0x7fffffff;
    if (!good) fault("a smoothing group that is no number: taken as off");
    out_.text += "s ";
    append(good ? *group : 0);
    out_.text += '\n';
  }

  const ObjSurvey &survey_;
  const std::map<std::string, int> &materials_;
  LineFaults &faults_;
  std::string_view text_;
  std::vector<bool> bad_positions_, bad_normals_;  // by index, from 1
  bool looked_ahead_ = false;
  std::array<std::string_view, 8> words_;
  std::vector<Corner> corners_;
  std::size_t positions_ = 0, texture_coordinates_ = 0, normals_ = 0, line_number_ = 0;
  GuardedObj out_;
};

}  // namespace

ObjSurvey survey_obj(std::string_view text) {
  ObjSurvey survey;
  LineReader reader(text);
  std::size_t number = 0;
  for (std::string_view line; reader.next(line, number);) {
    std::string_view rest = line;
    switch (statement(take_word(rest))) {
      case Statement::position:
        survey.positions++;
        break;
      case Statement::texture_coordinate:
        survey.texture_coordinates++;
        break;
      case Statement::normal:
        survey.normals++;
        break;
      case Statement::face:
        survey.faces++;
        break;
      case Statement::line_or_point:
        survey.lines_and_points++;
        break;
      case Statement::free_form:
        survey.free_form++;
        break;
      case Statement::library:
        survey.libraries.push_back({std::string(trim(rest)), number});
        break;
      default:
        break;
    }
  }
  return survey;
}

GuardedObj guard_obj(std::string_view text, const ObjSurvey &survey, const std::map<std::string, int> &materials, LineFaults &faults) {
  return Guard(survey, materials, faults).run(text);
}

}  // namespace sunstone
