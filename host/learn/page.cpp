// SPDX-License-Identifier: Apache-2.0
#include "learn/page.h"

#include <fmt/format.h>

#include <span>

#include "base/error.h"
#include "base/file.h"
#include "learn/plot.h"

namespace sunstone {

namespace {

constexpr const char *style =
    ":root{color-scheme:light dark;--paper:#fdfdfb;--ink:#222;--faint:#666;--line:#d8d8d4;--shade:#f1f1ec}"
    "@media(prefers-color-scheme:dark){:root{--paper:#181a1b;--ink:#e4e4e0;--faint:#a0a09a;--line:#3a3d3f;--shade:#232628}}"
    "body{background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,sans-serif;max-width:64rem;margin:2rem auto;padding:0 1rem}"
    "h1{line-height:1.2;margin-bottom:.3rem}h2{margin-top:2.2rem}.lead{color:var(--faint);font-size:1.1rem;margin-top:0}"
    "code,pre{background:var(--shade);border-radius:3px;font:.9em ui-monospace,monospace}code{padding:.1em .3em}pre{padding:.6em .9em;white-space:pre-wrap;overflow-wrap:anywhere}"
    ".row{display:grid;grid-template-columns:repeat(auto-fit,minmax(max(9rem,calc((100% - (var(--n) - 1)*1rem)/var(--n) - .1px)),1fr));gap:1rem;margin:1rem 0}.row figure{max-width:32rem}figure{margin:0}"
    "figure img{width:100%;image-rendering:pixelated;border:1px solid var(--line);display:block}figcaption{color:var(--faint);font-size:.9rem;margin-top:.3rem}"
    ".wide{overflow-x:auto;margin:1rem 0}table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.92rem}"
    "th,td{border-bottom:1px solid var(--line);padding:.3rem .7rem;text-align:right;vertical-align:top}th:first-child,td:first-child,.words{text-align:left}td code{white-space:nowrap}"
    "thead th{border-bottom:2px solid var(--line)}svg{max-width:100%;height:auto}.plot{max-width:45rem;display:block}"
    "details{margin:.6rem 0;border:1px solid var(--line);border-radius:4px;padding:.4rem .8rem}summary{cursor:pointer}a{color:inherit}";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Plain text to HTML: markup escaped, `code` marked, and outside of it the hyphen of a negative number made a minus sign.
std::string marked(const std::string &text) {
  std::string result;
  bool code = false;
  const std::string plain = escaped(text);
  for (std::size_t i = 0; i < plain.size(); i++) {
    if (plain[i] == '`') {
      result += code ? "</code>" : "<code>";
      code = !code;
    } else if (!code && plain[i] == '-' && i + 1 < plain.size() && is_digit(plain[i + 1]) && (i == 0 || plain[i - 1] == ' ' || plain[i - 1] == '(')) {
      result += "−";
    } else {
      result += plain[i];
    }
  }
  return code ? result + "</code>" : result;
}

// Numbers stand under each other by their last digits, words by their first letters.
bool holds_words(const Table &table, std::size_t column) {
  std::size_t numbers = 0, words = 0;
  for (const std::vector<std::string> &row : table.rows)
    if (!row[column].empty()) (is_digit(row[column][0]) || is_digit(row[column].back()) ? numbers : words)++;
  return words > numbers;
}

std::string html_of(const Table &table) {
  std::vector<const char *> kinds;
  for (std::size_t i = 0; i < table.columns.size(); i++) kinds.push_back(i > 0 && holds_words(table, i) ? " class='words'" : "");
  const auto cells = [&](const std::vector<std::string> &row, const char *tag) {
    std::string text = "<tr>";
    for (std::size_t i = 0; i < row.size(); i++) text += fmt::format("<{0}{1}>{2}</{0}>", tag, kinds[i], marked(row[i]));
    return text + "</tr>\n";
  };
  std::string text = "<div class='wide'><table>\n<thead>" + cells(table.columns, "th") + "</thead>\n<tbody>";
  for (const std::vector<std::string> &row : table.rows) text += cells(row, "td");
  return text + "</tbody></table></div>\n";
}

std::string csv_field(const std::string &field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

void write_csv(const std::filesystem::path &path, const Table &table) {
  std::string text;
  const auto line = [&](const std::vector<std::string> &fields) {
    if (fields.size() != table.columns.size()) throw Error(path.filename().string(), "a row has not as many fields as there are columns");
    for (std::size_t i = 0; i < fields.size(); i++) text += (i ? "," : "") + csv_field(fields[i]);
    text += "\n";
  };
  line(table.columns);
  for (const std::vector<std::string> &row : table.rows) line(row);
  write_file(path, std::as_bytes(std::span(text)));
}

std::string base64(const std::vector<std::byte> &data) {
  constexpr const char *letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((data.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < data.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, data.size() - i);
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; k++) bits = bits << 8 | (k < n ? static_cast<unsigned>(data[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; k++) text += k <= n ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string data_uri(const std::filesystem::path &png) { return "data:image/png;base64," + base64(read_file(png)); }

Page::Page(std::string title, std::string lead) : title_(std::move(title)) {
  body_ = "<h1>" + escaped(title_) + "</h1>\n<p class='lead'>" + marked(lead) + "</p>\n";
}
void Page::heading(const std::string &text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }
void Page::text(const std::string &paragraph) { body_ += "<p>" + marked(paragraph) + "</p>\n"; }
void Page::command(const std::string &line) { body_ += "<pre>" + escaped(line) + "</pre>\n"; }
void Page::plot(const std::string &svg) { body_ += "<div class='wide'>" + svg + "</div>\n"; }
void Page::table(const Table &table) { body_ += html_of(table); }
void Page::folded(const std::string &summary, const Table &table) { body_ += "<details><summary>" + marked(summary) + "</summary>\n" + html_of(table) + "</details>\n"; }
void Page::drawing(const std::string &svg, const std::string &caption) { body_ += "<figure>" + svg + "<figcaption>" + marked(caption) + "</figcaption></figure>\n"; }
void Page::link(const std::string &address, const std::string &name, const std::string &text) {
  body_ += fmt::format("<p><a href='{}'><strong>{}</strong></a>. {}</p>\n", escaped(address), escaped(name), marked(text));
}

void Page::pictures(const std::vector<Picture> &row, std::size_t abreast) {
  // As few rows as there can be, and those of about the same length.
  const std::size_t count = std::max<std::size_t>(row.size(), 1), rows = (count + abreast - 1) / abreast;
  body_ += fmt::format("<div class='row' style='--n:{}'>\n", (count + rows - 1) / rows);
  for (const Picture &picture : row)
    body_ += fmt::format("<figure><img alt='{}' src='{}'><figcaption>{}</figcaption></figure>\n", escaped(picture.caption), data_uri(picture.file), marked(picture.caption));
  body_ += "</div>\n";
}

void Page::write(const std::filesystem::path &path) const {
  const std::string text = "<!DOCTYPE html>\n<html lang='en'>\n<head><meta charset='utf-8'><meta name='viewport' content='width=device-width,initial-scale=1'>\n<title>" + escaped(title_) +
                           "</title>\n<style>" + style + "</style></head>\n<body>\n" + body_ + "</body>\n</html>\n";
  write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace sunstone
