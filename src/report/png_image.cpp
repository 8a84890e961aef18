#include "report/png_image.h"

#include <png.h>

#include "support/error.h"

namespace goniofit {

std::string png_of_rgb(std::size_t width, std::size_t height, std::span<const std::uint8_t> rgb) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  // The largest that it can become, so that one pass suffices.
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(bytes, '\0');
  if (png_image_write_to_memory(&image, out.data(), &bytes, 0, rgb.data(), 0, nullptr) == 0) {
    throw system_error(std::string("cannot make a PNG: ") + image.message);
  }
  out.resize(bytes);
  return out;
}

}  // namespace goniofit
