// SPDX-License-Identifier: Apache-2.0
// The pass over a material library that comes before tinyobjloader. The loader takes missing numbers for 0, does not tell what was given from what
// was not, and reads a texture's name as a number where an option has fewer arguments than it could have ("-o 0.1 name.jpg").
#include <algorithm>
#include <array>
#include <charconv>

#include "base/error.h"
#include "base/file.h"
#include "import/obj_materials.h"

namespace sunstone {

namespace {

constexpr std::size_t largest_library = std::size_t(1) << 28, most_libraries = 256;

enum class Value { color, number, model, texture, unsupported, ignored };
struct Key {
  Value value;
  float lower = 0, upper = 0;  // of numbers; what lies beyond is clamped
  const char *canonical = nullptr;
};

const Key *find_key(std::string_view word) {
  static const std::map<std::string_view, Key> known{
      {"Kd", {Value::color, 0, 1}},
      {"Ks", {Value::color, 0, 1}},
      {"Ke", {Value::color, 0, 1e18f}},
      {"Tf", {Value::color, 0, 1}},
      {"Kt", {Value::color, 0, 1, "Tf"}},
      {"Ns", {Value::number, 0, 1e9f}},
      {"Ni", {Value::number, 1, 100}},
      {"d", {Value::number, 0, 1}},
      {"Tr", {Value::number, 0, 1}},
      {"Pr", {Value::number, 0, 1}},
      {"Pm", {Value::number, 0, 1}},
      {"illum", {Value::model}},
      {"map_Kd", {Value::texture}},
      {"map_Ks", {Value::texture}},
      {"map_Ke", {Value::texture}},
      {"map_ke", {Value::texture, 0, 0, "map_Ke"}},
      {"map_emissive", {Value::texture, 0, 0, "map_Ke"}},
      {"map_d", {Value::texture}},
      {"map_Pr", {Value::texture}},
      {"map_Pm", {Value::texture}},
      {"norm", {Value::texture}},
      {"map_Kn", {Value::texture, 0, 0, "norm"}},
      {"bump", {Value::unsupported}},
      {"map_bump", {Value::unsupported, 0, 0, "bump"}},
      {"map_Bump", {Value::unsupported, 0, 0, "bump"}},
      {"disp", {Value::unsupported}},
      {"map_disp", {Value::unsupported, 0, 0, "disp"}},
      {"map_Disp", {Value::unsupported, 0, 0, "disp"}},
      {"map_Ns", {Value::unsupported}},
      {"map_Tr", {Value::unsupported}},
      {"map_Ps", {Value::unsupported}},
      {"decal", {Value::unsupported}},
      {"refl", {Value::unsupported}},
      {"map_refl", {Value::unsupported, 0, 0, "refl"}},
      {"Ps", {Value::unsupported}},
      {"Pc", {Value::unsupported}},
      {"Pcr", {Value::unsupported}},
      {"aniso", {Value::unsupported}},
      {"anisor", {Value::unsupported}},
      {"Ka", {Value::ignored}},  // light from nowhere: a path tracer has the real one
      {"map_Ka", {Value::ignored}},
      {"map_aat", {Value::ignored}},
      {"sharpness", {Value::ignored}},
  };
  const auto found = known.find(word);
  return found == known.end() ? nullptr : &found->second;
}

const char *unsupported_text(std::string_view key) {
  if (key == "bump") return "bump maps are heights, not normals, and are not rendered (norm names a normal map)";
  if (key == "disp") return "displacement maps are not rendered";
  if (key == "refl") return "reflection maps are not rendered: surfaces reflect the scene";
  if (key == "Ps" || key == "map_Ps") return "sheen (Ps, map_Ps) is not rendered";
  if (key == "Pc" || key == "Pcr") return "clearcoat (Pc, Pcr) is not rendered";
  if (key == "aniso" || key == "anisor") return "anisotropy (aniso, anisor) is not rendered";
  if (key == "map_Ns") return "maps of the specular exponent (map_Ns) are not rendered";
  return "maps of this kind (map_Tr, decal) are not rendered";
}

void append(std::string &text, float value) {
  char digits[32];
  text += ' ';
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

// A texture's options and its name, wherever they stand in the line.
struct TextureLine {
  std::string name;
  float offset[3] = {0, 0, 0}, scale[3] = {1, 1, 1}, bump = 1;
  bool clamp = false;
  char channel = 0;
};

class TextureParser {
 public:
  TextureParser(LineFaults &faults, std::size_t line) : faults_(faults), line_(line) {}

  // Options come before the name; those that come after it are found by their words. A name may hold blanks.
  TextureLine run(std::string_view rest) {
    while (option(rest)) {
    }
    rest = trim(rest);
    std::size_t end = rest.size();
    for (std::size_t at = rest.find(" -"); at != rest.npos && end == rest.size(); at = rest.find(" -", at + 1)) {
      std::string_view after = rest.substr(at);
      if (known(take_word(after))) end = at;
    }
    std::string_view after = rest.substr(end);
    while (option(after)) {
    }
    if (!trim(after).empty()) faults_.add("what follows a texture's options was not understood", line_);
    out_.name = portable_name(rest.substr(0, end));
    return std::move(out_);
  }

 private:
  static bool known(std::string_view word) {
    static const std::set<std::string_view> words{"-blendu",  "-blendv", "-boost", "-bm", "-cc", "-clamp",  "-colorspace",
                                                  "-imfchan", "-mm",     "-o",     "-s",  "-t",  "-texres", "-type"};
    return words.count(word) > 0;
  }

  int numbers(std::string_view &rest, float *values, int most) {
    int count = 0;
    for (; count < most; count++) {
      std::string_view after = rest;
      const std::optional<float> value = parse_number(take_word(after));
      if (!value) break;
      values[count] = *value;
      rest = after;
    }
    return count;
  }

  bool option(std::string_view &rest) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    if (!known(word)) return false;
    float ignored[3];
    if (word == "-o")
      needed(numbers(after, out_.offset, 3));
    else if (word == "-s")
      needed(numbers(after, out_.scale, 3));
    else if (word == "-bm")
      needed(numbers(after, &out_.bump, 1));
    else if (word == "-texres")
      needed(numbers(after, ignored, 1));
    else if (word == "-t")
      unsupported("turbulence (-t)", needed(numbers(after, ignored, 3)));
    else if (word == "-boost")
      unsupported("sharpening (-boost)", needed(numbers(after, ignored, 1)));
    else if (word == "-mm")
      unsupported("a range of values (-mm)", needed(numbers(after, ignored, 2)));
    else {
      const std::string_view value = take_word(after);
      needed(!value.empty());
      if (word == "-clamp")
        out_.clamp = value == "on";
      else if (word == "-imfchan")
        out_.channel = value.empty() ? '\0' : value[0];
      else if (word == "-type")
        unsupported("a kind of reflection map (-type)", true);
      else if (word == "-cc")
        unsupported("colour correction (-cc)", value == "on");
      else if (word == "-colorspace")
        unsupported("a colour space (-colorspace)", true);
    }
    rest = after;
    return true;
  }

  bool needed(int count) {
    if (count == 0) faults_.add("a texture option without its value: ignored", line_);
    return count != 0;
  }
  void unsupported(const char *what, bool given) {
    if (given) faults_.add("textures: " + std::string(what) + " is not supported and ignored", line_);
  }

  LineFaults &faults_;
  std::size_t line_;
  TextureLine out_;
};

class Guard {
 public:
  Guard(GuardedMtl &out, LineFaults &faults) : out_(out), faults_(faults) {}

  void run(std::string_view text) {
    LineReader reader(text);
    for (std::string_view line; reader.next(line, line_);) {
      std::string_view rest = line;
      const std::string_view word = take_word(rest);
      rest = trim(rest);
      if (word == "newmtl") {
        begin(rest);
        continue;
      }
      const Key *key = find_key(word);
      if (!key)
        fault("not a statement of MTL: ignored");
      else if (!open_) {
        if (!skipping_) fault("a statement before the first newmtl: ignored");
      } else
        statement(*key, key->canonical ? key->canonical : word, rest);
    }
  }

 private:
  void fault(const std::string &what) { faults_.add(what, line_); }

  void begin(std::string_view name) {
    open_ = false;
    skipping_ = true;
    if (name.empty()) return fault("a material without a name: ignored");
    if (!out_.numbers.emplace(std::string(name), static_cast<int>(out_.names.size())).second)
      return fault("a material of a name that was there before: the first one is used");
    out_.text += "newmtl " + std::to_string(out_.names.size()) + "\n";
    out_.names.emplace_back(name);
    out_.given.emplace_back();
    open_ = true;
  }

  void statement(const Key &key, std::string_view name, std::string_view rest) {
    switch (key.value) {
      case Value::color:
        color(key, name, without_comment(rest));
        break;
      case Value::number:
        number(key, name, without_comment(rest));
        break;
      case Value::model:
        model(without_comment(rest));
        break;
      case Value::texture:
        texture(name, rest);
        break;
      case Value::unsupported:
        fault(unsupported_text(name));
        break;
      case Value::ignored:
        break;
    }
  }

  float clamped(const Key &key, std::string_view name, float value) {
    if (value >= key.lower && value <= key.upper) return value;
    fault(std::string(name) + " is out of range: taken as the nearest value that is in it");
    return std::clamp(value, key.lower, key.upper);
  }

  // "r g b", or one number for all three.
  void color(const Key &key, std::string_view name, std::string_view rest) {
    std::vector<float> values;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const std::optional<float> value = parse_number(word);
      if (!value) {
        const bool other = word == "spectral" || word == "xyz";
        return fault(other ? "colours given as spectra or as xyz are not read: ignored"
                           : std::string(name) + " that is not made of finite numbers: ignored");
      }
      values.push_back(*value);
    }
    if (values.size() != 1 && values.size() < 3) return fault(std::string(name) + " without its three numbers: ignored");
    std::string text(name);
    for (int i = 0; i < 3; i++) append(text, clamped(key, name, values[values.size() == 1 ? 0 : i]));
    write(name, text);
  }

  void number(const Key &key, std::string_view name, std::string_view rest) {
    std::string_view word = take_word(rest);
    if (name == "d" && word == "-halo") {
      fault("d -halo is not rendered: taken as d");
      word = take_word(rest);
    }
    const std::optional<float> value = parse_number(word);
    if (!value) return fault(std::string(name) + " without a finite number: ignored");
    if (name == "Ni" && *value < 1) return fault("Ni below 1: ignored");
    if (name == "Tr" && out_.given.back().count("d")) return;  // d wins, in either order
    std::string text(name);
    append(text, clamped(key, name, *value));
    write(name, text);
  }

  void model(std::string_view rest) {
    const std::optional<std::int64_t> value = parse_integer(take_word(rest));
    if (!value || *value < 0 || *value > 10) return fault("illum that is not 0 to 10: ignored");
    if (*value == 10) fault("illum 10, shadows on invisible surfaces, is not rendered: taken as 2");
    write("illum", "illum " + std::to_string(*value));
  }

  void texture(std::string_view name, std::string_view rest) {
    const TextureLine line = TextureParser(faults_, line_).run(rest);
    if (line.name.empty()) return fault("a texture without a name: ignored");
    std::string text = std::string(name) + " -o";
    for (const float value : line.offset) append(text, value);
    text += " -s";
    for (const float value : line.scale) append(text, value);
    text += " -bm";
    append(text, line.bump);
    if (line.clamp) text += " -clamp on";
    if (line.channel) (text += " -imfchan ") += line.channel;
    write(name, text + " " + line.name);
  }

  void write(std::string_view name, const std::string &text) {
    out_.text += text;
    out_.text += '\n';
    out_.given.back().emplace(name);
  }

  GuardedMtl &out_;
  LineFaults &faults_;
  std::size_t line_ = 0;
  bool open_ = false, skipping_ = false;
};

// The names in an mtllib line: the whole of it, where there is such a file, for exporters do not escape blanks; else its words, "\ " being a blank.
std::vector<std::string> library_names(const std::string &rest) {
  std::vector<std::string> names(1);
  for (std::size_t i = 0; i < rest.size(); i++) {
    if (rest[i] == '\\' && i + 1 < rest.size() && rest[i + 1] == ' ')
      names.back() += rest[++i];
    else if (rest[i] == ' ' || rest[i] == '\t')
      names.emplace_back();
    else
      names.back() += rest[i];
  }
  std::erase(names, "");
  return names;
}

class LibraryReader {
 public:
  LibraryReader(const std::filesystem::path &obj, const ImportOptions &options, Notices &notices)
      : folder_(obj.parent_path()), shown_(printable(obj.string(), 400)), options_(options), notices_(notices) {}

  GuardedMtl run(const ObjSurvey &survey) {
    for (const ObjSurvey::Library &library : survey.libraries) {
      const std::string place = shown_ + ":" + std::to_string(library.line);
      const std::vector<std::string> words = library_names(library.rest);
      if (words.empty()) notices_.warning(place, "mtllib names no file");
      if (words.size() > 1 && is_file(portable_name(library.rest)))
        read(portable_name(library.rest), place);
      else
        for (const std::string &word : words) read(portable_name(word), place);
    }
    return std::move(out_);
  }

 private:
  bool is_file(const std::string &name) const {
    std::error_code error;
    try {
      return !names_drive(name) && std::filesystem::is_regular_file(resolve_resource(folder_, name, options_, shown_), error);
    } catch (const Error &) {
      return false;
    }
  }

  void read(const std::string &name, const std::string &place) {
    if (seen_.size() > most_libraries) return;
    if (!seen_.insert(name).second) return;
    if (seen_.size() > most_libraries)
      return notices_.warning(place, "names more than " + std::to_string(most_libraries) + " material libraries: the rest is not read");
    try {
      if (names_drive(name) && !options_.allow_outside) throw Error(place, "it is an absolute path and is not read");
      const std::filesystem::path path = resolve_resource(folder_, name, options_, place);
      const std::vector<std::byte> data = read_file(path, largest_library);
      LineFaults faults(printable((folder_ / name).string(), 400));
      const std::size_t before = out_.names.size();
      guard_mtl(checked_text({reinterpret_cast<const char *>(data.data()), data.size()}, faults.file()), out_, faults);
      faults.report(notices_);
      if (out_.names.size() == before) notices_.warning(place, "there is no material in \"" + printable(name) + "\"");
    } catch (const Error &error) {
      notices_.warning(place, "the material library \"" + printable(name) + "\" is not used: " + error.reason);
    }
  }

  const std::filesystem::path folder_;
  const std::string shown_;
  const ImportOptions &options_;
  Notices &notices_;
  std::set<std::string> seen_;
  GuardedMtl out_;
};

}  // namespace

void guard_mtl(std::string_view text, GuardedMtl &out, LineFaults &faults) { Guard(out, faults).run(text); }

GuardedMtl read_libraries(const ObjSurvey &survey, const std::filesystem::path &obj, const ImportOptions &options, Notices &notices) {
  return LibraryReader(obj, options, notices).run(survey);
}

}  // namespace sunstone
