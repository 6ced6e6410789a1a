// SPDX-License-Identifier: Apache-2.0
// Pages of HTML that stand alone: pictures as data URIs, plots inline, one style for light and dark, nothing fetched from anywhere.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sunstone {

// Figures in rows, for the page and as CSV.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // each as long as `columns`
};

// Numbers in a CSV are plain ones; fields with commas, quotes or line ends are quoted [RFC4180].
void write_csv(const std::filesystem::path &path, const Table &table);

struct Picture {
  std::filesystem::path file;  // a PNG
  std::string caption;
};

class Page {
 public:
  Page(std::string title, std::string lead);
  void heading(const std::string &text);
  void text(const std::string &paragraph);          // plain text: what is markup is escaped; `code` between backquotes
  void command(const std::string &line);            // that gives the same elsewhere
  void pictures(const std::vector<Picture> &row, std::size_t abreast = 4);  // side by side where there is room, at most `abreast`; pixels unsmoothed
  void plot(const std::string &svg);                // by plot.h
  void table(const Table &table);
  void folded(const std::string &summary, const Table &table);  // to be opened by the reader
  void drawing(const std::string &svg, const std::string &caption);
  void link(const std::string &address, const std::string &name, const std::string &text);
  void write(const std::filesystem::path &path) const;

 private:
  std::string title_, body_;
};

// "data:image/png;base64,..." of a file.
std::string data_uri(const std::filesystem::path &png);
std::string base64(const std::vector<std::byte> &data);

}  // namespace sunstone
