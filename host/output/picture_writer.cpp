// SPDX-License-Identifier: Apache-2.0
#include "output/picture_writer.h"

#include <new>

#include "base/error.h"
#include "base/file.h"

namespace sunstone {

PictureWriter::PictureWriter(std::filesystem::path path, const char *format, const OIIO::ImageSpec &spec) : path_(std::move(path)), top_(spec.y) {
  output_ = OIIO::ImageOutput::create(format);
  if (!output_ || !output_->supports("ioproxy")) {
    OIIO::geterror();
    throw Error(printable(path_.string(), 400), std::string("this build of OpenImageIO cannot write ") + format);
  }
  output_->set_ioproxy(&memory_);
  // The library dates a picture that has no date of its own, and two runs would differ.
  OIIO::ImageSpec undated = spec;
  undated.attribute("DateTime", "");
  // Only the name's suffix matters here: the bytes go to memory.
  if (!output_->open(std::string("picture.") + format, undated)) fail();
}

PictureWriter::~PictureWriter() = default;

void PictureWriter::fail() {
  const std::string text = output_->geterror();
  throw Error(printable(path_.string(), 400), "could not be encoded" + (text.empty() ? "" : ": " + printable(text.substr(0, text.find('\n')), 200)));
}

void PictureWriter::rows(int begin, int end, OIIO::TypeDesc type, const void *pixels) {
  if (!output_->write_scanlines(top_ + begin, top_ + end, 0, type, pixels)) fail();
}

void PictureWriter::finish() {
  if (!output_->close()) fail();
  write_file(path_, std::as_bytes(std::span(memory_.buffer())));
}

}  // namespace sunstone
