// SPDX-License-Identifier: Apache-2.0
// The .film format. Every size is checked against the file's own length before anything is allocated for it, and the hash before anything is
// believed.
#include "film/film_file.h"

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/file.h"

namespace sunstone {

namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "films are little-endian files");

constexpr char magic[8] = {'S', 'U', 'N', 'F', 'I', 'L', 'M', '1'};
constexpr int version = 1;
constexpr std::uint64_t hash_bytes = 16;
constexpr std::uint64_t longest_header = std::uint64_t(1) << 24;
constexpr int largest_side = 1 << 20;
constexpr std::uint64_t most_pixels = std::uint64_t(1) << 28;
constexpr std::size_t most_layers = 4096;
constexpr std::uint64_t most_samples = std::uint64_t(1) << 32;  // a sample's number has 32 bits

struct CloseFile {
  void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string shown(const std::filesystem::path &path) { return printable(path.string(), 400); }

// Writes bytes and hashes them on the way.
class Writer {
 public:
  explicit Writer(const std::filesystem::path &path, std::string place) : place_(std::move(place)), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) fail();
  }
  void bytes(const void *data, std::size_t size) {
    hasher_.bytes(data, size);
    raw(data, size);
  }
  void finish() {
    const Hash hash = hasher_.digest();
    raw(&hash.low, sizeof hash.low);
    raw(&hash.high, sizeof hash.high);
    if (std::fclose(file_.release()) != 0) fail();
  }

 private:
  void raw(const void *data, std::size_t size) {
    if (size && std::fwrite(data, 1, size, file_.get()) != size) fail();
  }
  [[noreturn]] void fail() { throw Error(place_, std::string("could not be written: ") + std::strerror(errno)); }
  std::string place_;
  File file_;
  Hasher hasher_;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path &path) : place_(shown(path)) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
      throw Error(place_, error && error != std::errc::no_such_file_or_directory ? error.message() : "no such file");
    if (!std::filesystem::is_regular_file(status)) throw Error(place_, "is not a regular file");
    length_ = std::filesystem::file_size(path, error);
    if (error) throw Error(place_, error.message());
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) throw Error(place_, std::strerror(errno));
  }
  std::uint64_t length() const { return length_; }
  void bytes(void *data, std::size_t size) {
    raw(data, size);
    hasher_.bytes(data, size);
  }
  void check_hash() {
    Hash stored;
    raw(&stored.low, sizeof stored.low);
    raw(&stored.high, sizeof stored.high);
    if (std::fgetc(file_.get()) != EOF || stored != hasher_.digest()) fail("is damaged: its hash does not match its contents");
  }
  [[noreturn]] void fail(const std::string &reason) const { throw Error(place_, reason); }

 private:
  void raw(void *data, std::size_t size) {
    if (size && std::fread(data, 1, size, file_.get()) != size) fail(std::ferror(file_.get()) ? std::strerror(errno) : "is cut off");
  }
  std::string place_;
  File file_;
  std::uint64_t length_ = 0;
  Hasher hasher_;
};

json header_of(const Film &film) {
  json samples = json::array(), layers = json::array();
  for (const SampleRange &range : film.samples) samples.push_back({range.first, range.last});
  for (const FilmLayer &layer : film.layers) layers.push_back(layer.name);
  return {{"version", version},
          {"picture", {film.picture_width, film.picture_height}},
          {"window", {film.x0, film.y0, film.x1, film.y1}},
          {"samples", samples},
          {"layers", layers},
          {"scene_hash", film.scene_hash},
          {"settings", film.settings},
          {"information", film.information},
          {"clamped", film.clamped},
          {"nan", film.nan},
          {"interrupted", film.interrupted}};
}

// A member of the header has to be there, and of its type; what is not known is refused, since it might change what the integers mean.
class Header {
 public:
  Header(const std::string &text, const Reader &reader) : reader_(reader) {
    if (text.find('\0') != std::string::npos)
      reader_.fail("its header is not JSON: it holds a zero byte");  // where the parser would stop, and be content
    std::vector<std::set<std::string>> keys;
    const auto strict = [&](int depth, json::parse_event_t event, json &parsed) {
      if (depth > 3) reader_.fail("its header is nested too deeply");
      if (event == json::parse_event_t::object_start) keys.emplace_back();
      if (event == json::parse_event_t::object_end) keys.pop_back();
      if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
        reader_.fail("its header has \"" + printable(parsed.get<std::string>()) + "\" twice");
      return true;
    };
    try {
      object_ = json::parse(text, strict);
    } catch (const json::exception &error) {
      reader_.fail("its header is not JSON: " + printable(error.what()));
    }
    if (!object_.is_object()) reader_.fail("its header is not a JSON object");
  }

  const json &member(const char *key, json::value_t type) {
    const auto found = object_.find(key);
    if (found == object_.end()) reader_.fail(std::string("its header lacks \"") + key + "\"");
    if (found->type() != type) wrong(key);
    taken_.insert(key);
    return *found;
  }
  std::uint64_t number(const char *key) { return member(key, json::value_t::number_unsigned).get<std::uint64_t>(); }
  std::string text(const char *key) { return member(key, json::value_t::string).get<std::string>(); }
  bool flag(const char *key) { return member(key, json::value_t::boolean).get<bool>(); }
  std::vector<std::uint64_t> numbers(const char *key, std::size_t count) { return numbers(member(key, json::value_t::array), key, count); }
  std::vector<std::uint64_t> numbers(const json &array, const char *key, std::size_t count) {
    if (!array.is_array() || array.size() != count) wrong(key);
    std::vector<std::uint64_t> values;
    for (const json &value : array) {
      if (!value.is_number_unsigned()) wrong(key);
      values.push_back(value.get<std::uint64_t>());
    }
    return values;
  }
  std::map<std::string, std::string> texts(const char *key) {
    std::map<std::string, std::string> values;
    for (const auto &[name, value] : member(key, json::value_t::object).items()) {
      if (!value.is_string()) wrong(key);
      values.emplace(name, value.get<std::string>());
    }
    return values;
  }
  void check_all_taken() const {
    for (const auto &[key, value] : object_.items())
      if (!taken_.contains(key)) reader_.fail("its header has \"" + printable(key) + "\", which is not known");
  }
  [[noreturn]] void wrong(const char *key) const { reader_.fail(std::string("its header's \"") + key + "\" is not what it should be"); }

 private:
  const Reader &reader_;
  json object_;
  std::set<std::string> taken_;
};

// All of a film but its integers. Every number is bounded here, so that the products that follow cannot overflow.
Film film_of(Header &header, const Reader &reader) {
  if (const std::uint64_t written = header.number("version"); written != version)
    reader.fail("was written by a newer version of sunstone: its format is " + std::to_string(written) + ", and this one reads " +
                std::to_string(version));
  Film film;
  const std::vector<std::uint64_t> picture = header.numbers("picture", 2), window = header.numbers("window", 4);
  if (picture[0] < 1 || picture[1] < 1 || picture[0] > largest_side || picture[1] > largest_side) header.wrong("picture");
  if (window[0] >= window[2] || window[1] >= window[3] || window[2] > picture[0] || window[3] > picture[1]) header.wrong("window");
  film.picture_width = static_cast<int>(picture[0]), film.picture_height = static_cast<int>(picture[1]);
  film.x0 = static_cast<int>(window[0]), film.y0 = static_cast<int>(window[1]);
  film.x1 = static_cast<int>(window[2]), film.y1 = static_cast<int>(window[3]);
  if (film.pixels() > most_pixels) header.wrong("window");

  for (const json &entry : header.member("samples", json::value_t::array)) {
    const std::vector<std::uint64_t> range = header.numbers(entry, "samples", 2);
    // Sorted, disjoint, not adjacent and none empty: else two equal films could differ.
    if (range[0] >= range[1] || range[1] > most_samples || (!film.samples.empty() && range[0] <= film.samples.back().last)) header.wrong("samples");
    film.samples.push_back({range[0], range[1]});
  }
  std::set<std::string> names;
  for (const json &entry : header.member("layers", json::value_t::array)) {
    if (!entry.is_string() || !names.insert(entry.get<std::string>()).second || names.size() > most_layers) header.wrong("layers");
    film.layers.push_back({entry.get<std::string>(), {}});
  }
  if (film.layers.size() < SUN_LAYER_FIRST_OPTIONAL || film.layers[SUN_LAYER_EVEN].name != "beauty.even" ||
      film.layers[SUN_LAYER_ODD].name != "beauty.odd")
    header.wrong("layers");
  film.scene_hash = header.text("scene_hash");
  film.settings = header.texts("settings");
  film.information = header.texts("information");
  film.clamped = header.number("clamped");
  film.nan = header.number("nan");
  film.interrupted = header.flag("interrupted");
  header.check_all_taken();
  return film;
}

}  // namespace

void write_film(const std::filesystem::path &path, const Film &film) {
  const std::size_t values = film.pixels() * SUN_FILM_CHANNELS * SUN_FILM_BINS;
  for (const FilmLayer &layer : film.layers)
    if (layer.values.size() != values)
      throw Error(shown(path), "could not be written: layer " + printable(layer.name) + " does not fit the film's window");
  // A file name may hold bytes that are no UTF-8; JSON may not.
  const std::string header = header_of(film).dump(-1, ' ', false, json::error_handler_t::replace);
  const std::uint64_t header_length = header.size();
  if (header_length > longest_header)
    throw Error(shown(path), "could not be written: its header would have " + std::to_string(header_length) + " bytes");
  AtomicFile atomic(path);
  Writer writer(atomic.temporary(), shown(path));
  writer.bytes(magic, sizeof magic);
  writer.bytes(&header_length, sizeof header_length);
  writer.bytes(header.data(), header.size());
  for (const FilmLayer &layer : film.layers) writer.bytes(layer.values.data(), layer.values.size() * sizeof(std::int64_t));
  writer.finish();
  atomic.commit();
}

Film read_film(const std::filesystem::path &path) {
  Reader reader(path);
  constexpr std::uint64_t fixed_bytes = sizeof magic + sizeof(std::uint64_t) + hash_bytes;
  char start[sizeof magic];
  if (reader.length() < sizeof start) reader.fail("is no film");
  reader.bytes(start, sizeof start);
  if (std::memcmp(start, magic, sizeof magic - 1) != 0) reader.fail("is no film");
  if (start[7] != magic[7]) reader.fail("is a film of another version of sunstone's format");
  if (reader.length() < fixed_bytes) reader.fail("is cut off");
  std::uint64_t header_length = 0;
  reader.bytes(&header_length, sizeof header_length);
  if (header_length > reader.length() - fixed_bytes) reader.fail("is cut off, or its header's length is wrong");
  if (header_length > longest_header) reader.fail("its header claims " + std::to_string(header_length) + " bytes");
  std::string text(header_length, '\0');
  reader.bytes(text.data(), text.size());
  Header header(text, reader);
  Film film = film_of(header, reader);
  film.name = path.string();

  const std::uint64_t values = static_cast<std::uint64_t>(film.pixels()) * SUN_FILM_CHANNELS * SUN_FILM_BINS;
  const std::uint64_t expected = fixed_bytes + header_length + values * sizeof(std::int64_t) * film.layers.size();
  if (reader.length() != expected)
    reader.fail((reader.length() < expected ? "is cut off: " : "is too long: ") + std::to_string(reader.length()) + " bytes, but its header needs " +
                std::to_string(expected));
  try {
    for (FilmLayer &layer : film.layers) {
      layer.values.resize(values);
      reader.bytes(layer.values.data(), values * sizeof(std::int64_t));
    }
  } catch (const std::bad_alloc &) {
    reader.fail("does not fit into memory: it has " + std::to_string(expected) + " bytes");
  }
  reader.check_hash();
  return film;
}

}  // namespace sunstone
