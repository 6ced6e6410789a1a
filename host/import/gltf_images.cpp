// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_images.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#include "base/error.h"

namespace sunstone::gltf {

namespace {

constexpr std::size_t max_decoded_bytes = std::size_t(1) << 33;  // of all images together

Wrap wrap_mode(const Value &value) {
  switch (value.whole(10497)) {
    case 10497:
      return Wrap::repeat;
    case 33648:
      return Wrap::mirror;
    case 33071:
      return Wrap::clamp;
  }
  value.fail(std::to_string(value.whole(0)) + " is no wrapping mode: 10497, 33648 or 33071");
}

// Where an image's bytes come from. Views are looked up on one thread, since buffers are loaded on demand; files are read, and all decoded, on any.
struct Source {
  std::size_t image = 0;
  std::string place;
  std::optional<Value> uri;
  std::span<const std::byte> bytes;  // where there is no uri
  Image result;
  std::string fault_place, fault;
};

void note_fault(Source &source, const Error &error) {
  // The error's place, where it is a property of the image; else (a buffer that cannot be read, say) the image is named first.
  const bool within = error.place.starts_with(source.place);
  source.fault_place = within ? error.place : source.place;
  source.fault = within ? error.reason + (error.hint.empty() ? "" : " (" + error.hint + ")") : error.what();
}

void prepare(Source &source, const Value &value, Buffers &buffers) {
  value.expect_object();
  value.check_extensions({});
  const Value uri = value["uri"], view = value["bufferView"];
  if (uri) {
    source.uri = uri;
  } else if (view) {
    source.bytes = buffers.view(view).bytes;
  } else {
    value.fail("has neither a uri nor a bufferView");
  }
}

void decode(Source &source) {
  std::vector<std::byte> own;
  if (source.uri) {
    own = read_uri(*source.uri);
    source.bytes = own;
  }
  source.result = decode_image(source.bytes, source.place);
}

std::size_t bytes_of(const Image &image) {
  const std::size_t values =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * static_cast<std::size_t>(image.channels);
  return values * (image.is_float() ? 4 : 1);
}

}  // namespace

int Images::texture(const Value &reference, Scene &scene) {
  const std::size_t index = reference.index(textures_.size(), "textures");
  if (numbers_.empty()) numbers_.assign(textures_.size(), -2);
  if (numbers_[index] != -2) return numbers_[index];
  numbers_[index] = -1;
  const Value value = textures_[index];
  value.expect_object();
  value.check_extensions({"EXT_texture_webp", "KHR_texture_basisu"});

  Value source = value.extension("EXT_texture_webp")["source"];
  if (!source) source = value["source"];
  if (value.extension("KHR_texture_basisu"))
    value.context().report.once(value.context().file, source ? "KHR_texture_basisu is not supported: another image is read instead"
                                                             : "KHR_texture_basisu is not supported: such textures are left out");
  else if (!source)
    value.warn("names no image and was left out");
  if (!source) return -1;
  const std::size_t image = source.index(images_.size(), "images");

  Texture texture;
  if (const Value sampler_reference = value["sampler"]) {
    const Value sampler = samplers_[sampler_reference.index(samplers_.size(), "samplers")];
    sampler.expect_object();
    sampler.check_extensions({});
    texture.wrap_u = wrap_mode(sampler["wrapS"]);
    texture.wrap_v = wrap_mode(sampler["wrapT"]);
    const Value filter = sampler["magFilter"];
    const std::uint64_t mode = filter.whole(9729);
    if (mode != 9728 && mode != 9729) filter.fail(std::to_string(mode) + " is no magnification filter: 9728 or 9729");
    texture.linear = mode == 9729;
  }
  numbers_[index] = static_cast<int>(scene.textures.size());
  scene.textures.push_back(texture);
  sources_.push_back(image);
  return numbers_[index];
}

void Images::read(Scene &scene) {
  std::vector<Source> sources;
  std::vector<int> source_of(images_.size(), -1);
  for (const std::size_t image : sources_) {
    if (source_of[image] >= 0) continue;
    source_of[image] = static_cast<int>(sources.size());
    Source source;
    source.image = image;
    const Value value = images_[image];
    source.place = value.full_place();
    try {
      prepare(source, value, buffers_);
    } catch (const Error &error) {
      note_fault(source, error);
    }
    sources.push_back(std::move(source));
  }

  // Results and faults go into each source's own place and are looked at in order afterwards, so threads change no bit and no message.
  std::atomic<std::size_t> next{0}, decoded{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < sources.size();) {
      Source &source = sources[i];
      if (!source.fault.empty()) continue;
      try {
        decode(source);
        if (decoded.fetch_add(bytes_of(source.result)) + bytes_of(source.result) > max_decoded_bytes) {
          source.result = {};
          note_fault(source, Error(source.place, "all images together take more than " + std::to_string(max_decoded_bytes >> 30) + " GiB"));
        }
      } catch (const Error &error) {
        note_fault(source, error);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> threads;
  const std::size_t count = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), sources.size());
  try {
    for (std::size_t i = 1; i < count; i++) threads.emplace_back(work);
  } catch (const std::system_error &) {
    // No more threads to be had: those there are do it all.
  }
  work();
  threads.clear();  // joins
  if (failure) std::rethrow_exception(failure);

  std::vector<int> number(images_.size(), -1);
  for (Source &source : sources) {
    if (!source.fault.empty()) {
      images_.context().report.warning(source.fault_place, source.fault + "; the texture was left out");
      continue;
    }
    number[source.image] = static_cast<int>(scene.images.size());
    scene.images.push_back(std::move(source.result));
  }
  for (std::size_t i = 0; i < sources_.size(); i++) scene.textures[i].image = number[sources_[i]];
}

}  // namespace sunstone::gltf
