// SPDX-License-Identifier: Apache-2.0
// The door out to OpenImageIO: a picture is encoded into memory, then written beside and renamed, so that a full disk is noticed whatever the format.
#pragma once
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>

namespace sunstone {

class PictureWriter {
 public:
  // `format` is OpenImageIO's name of it.
  PictureWriter(std::filesystem::path path, const char *format, const OIIO::ImageSpec &spec);
  ~PictureWriter();
  PictureWriter(const PictureWriter &) = delete;
  PictureWriter &operator=(const PictureWriter &) = delete;

  // Rows [begin, end), counted from the top of the data window; `type` unknown: each channel as the file has it.
  void rows(int begin, int end, OIIO::TypeDesc type, const void *pixels);

  // Nothing is at `path` before this returns.
  void finish();

 private:
  [[noreturn]] void fail();
  std::filesystem::path path_;
  OIIO::Filesystem::IOVecOutput memory_;
  std::unique_ptr<OIIO::ImageOutput> output_;
  int top_ = 0;
};

}  // namespace sunstone
