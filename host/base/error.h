// SPDX-License-Identifier: Apache-2.0
// The one error type. cli/main.cpp alone makes exit statuses of it.
#pragma once
#include <stdexcept>
#include <string>

namespace sunstone {

// The work failed (exit status 1). `place` says where: file, object, line; `reason` what; `hint` what to do.
class Error : public std::runtime_error {
 public:
  Error(std::string place, std::string reason, std::string hint = {});
  const std::string place, reason, hint;
};

// Wrong usage (exit status 2).
class UsageError : public Error {
 public:
  using Error::Error;
};

// `text` fit for one line of a terminal: control characters and invalid UTF-8 escaped, shortened in the middle beyond `limit` bytes.
std::string printable(std::string_view text, std::size_t limit = 120);

}  // namespace sunstone
