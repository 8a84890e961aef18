#include "io/png_file.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <string_view>

#include "support/error.h"
#include "support/output_file.h"
#include "support/text.h"

namespace goniofit {

namespace {

// What libpng calls back into. It reports by a message and a jump; nothing with a destructor may live in the frame that
// is jumped over, so the picture's rows and the texts are made ready before.
struct Writing {
  std::string bytes;
  std::string complaint;
};

void append(png_structp png, png_bytep data, std::size_t size) {
  static_cast<Writing*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
}
void keep_everything(png_structp) {}
[[noreturn]] void complain(png_structp png, png_const_charp message) {
  static_cast<Writing*>(png_get_error_ptr(png))->complaint = message;
  png_longjmp(png, 1);
}
void pass_over(png_structp, png_const_charp) {}

bool is_keyword(std::string_view word) {
  const bool printable = std::all_of(word.begin(), word.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return printable && !word.empty() && word.size() <= 79 && word.front() != ' ' && word.back() != ' ' &&
         word.find("  ") == std::string_view::npos;
}

void expect_writable(const RgbPicture& picture, const PictureTexts& texts) {
  constexpr std::size_t largest_side = 1'000'000;  // of libpng, unless told otherwise
  const bool sized = picture.width > 0 && picture.height > 0 && picture.width <= largest_side &&
                     picture.height <= largest_side && picture.bytes.size() == 3 * picture.width * picture.height;
  if (!sized) {
    throw usage_error("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                      " pixels with " + std::to_string(picture.bytes.size()) + " bytes, expected three a pixel");
  }
  for (const auto& [keyword, text] : texts) {
    if (!is_keyword(keyword))
      throw usage_error("PNG text " + in_quotes(keyword) + ", expected a keyword of 1 to 79 letters");
  }
}

std::vector<png_text> chunks_of(const PictureTexts& texts) {
  std::vector<png_text> chunks;
  for (const auto& [keyword, text] : texts) {
    png_text chunk{};
    chunk.compression = PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(keyword.c_str());
    chunk.text = const_cast<char*>(text.c_str());
    chunk.itxt_length = text.size();
    chunks.push_back(chunk);
  }
  return chunks;
}

// False after a complaint. Of all frames between here and complain() only C's have anything to clean up.
bool write_all(png_structp png, png_infop info, const RgbPicture& picture, const std::vector<png_text>& chunks) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (!chunks.empty()) png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
  png_write_info(png, info);
  for (std::size_t row = 0; row < picture.height; ++row) {
    png_write_row(png, picture.bytes.data() + 3 * picture.width * row);
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::uint8_t srgb_byte(double linear) noexcept {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

std::string to_png(const RgbPicture& picture, const PictureTexts& texts) {
  expect_writable(picture, texts);
  const std::vector<png_text> chunks = chunks_of(texts);
  Writing writing;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, complain, pass_over);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool done = false;
  if (info != nullptr) {
    png_set_write_fn(png, &writing, append, keep_everything);
    done = write_all(png, info, picture, chunks);
  }
  png_destroy_write_struct(&png, &info);
  if (!done) throw system_error("cannot write a PNG: " + (writing.complaint.empty() ? "no memory" : writing.complaint));
  return std::move(writing.bytes);
}

void write_png(const std::filesystem::path& path, const RgbPicture& picture, const PictureTexts& texts) {
  write_file(path, to_png(picture, texts));
}

}  // namespace goniofit
