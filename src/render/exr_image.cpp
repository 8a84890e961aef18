#include "render/exr_image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <cstdint>

#include "io/line_reader.h"
#include "support/error.h"
#include "support/output_file.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t most_values = std::size_t{1} << 28U;
constexpr std::size_t best_deflate_ratio = 1032;

void expect_writable(const ExrImage& image) {
  bool good =
      image.width > 0 && image.height > 0 && !image.channels.empty() && image.channels.size() == image.values.size();
  for (const std::vector<float>& values : image.values) good = good && values.size() == image.width * image.height;
  if (!good) throw usage_error("an image without channels, or with too few values, expected one a pixel and channel");
}

Imf::Header header_of(const ExrImage& image) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& channel : image.channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  for (const auto& [name, text] : image.attributes) header.insert(name, Imf::StringAttribute(text));
  return header;
}

class ImageReader {
 public:
  explicit ImageReader(const std::filesystem::path& path)
      : source_(path.string()), file_bytes_(std::filesystem::file_size(path)), file_(source_.c_str(), 1) {}

  ExrImage read() {
    const Imf::Header& header = file_.header();
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
    const auto height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1) fail("has no pixels");
    image_.width = static_cast<std::size_t>(width);
    image_.height = static_cast<std::size_t>(height);
    read_channels(header);
    read_texts(header);
    return std::move(image_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw input_error(source_, 0, "", what); }

  void read_channels(const Imf::Header& header) {
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
        fail("channel " + in_quotes(c.name()) + " has not one value a pixel");
      }
      image_.channels.emplace_back(c.name());
    }
    if (image_.channels.empty()) fail("has no channels, expected at least one");
    // Before memory is taken for it: what is claimed must be within bounds and within what deflate could pack.
    const std::size_t values = image_.channels.size();
    if (image_.width > most_values / image_.height / values) fail("claims more than 2^28 values, expected fewer");
    if (image_.width * image_.height * values / best_deflate_ratio > file_bytes_) {
      fail("claims more values than it can hold");
    }
    if (!file_.isComplete()) fail("is not complete");
    image_.values.assign(values, std::vector<float>(image_.width * image_.height));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < values; ++c) {
      frame.insert(image_.channels[c], Imf::Slice::Make(Imf::FLOAT, image_.values[c].data(), header.dataWindow()));
    }
    file_.setFrameBuffer(frame);
    file_.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
    for (std::size_t c = 0; c < values; ++c) {
      for (const float value : image_.values[c]) {
        if (!std::isfinite(value)) fail("channel " + in_quotes(image_.channels[c]) + " has a value that is not finite");
      }
    }
  }

  void read_texts(const Imf::Header& header) {
    for (auto a = header.begin(); a != header.end(); ++a) {
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) {
        image_.attributes.emplace_back(a.name(), text->value());
      }
    }
  }

  std::string source_;
  std::uintmax_t file_bytes_;
  Imf::InputFile file_;
  ExrImage image_;
};

}  // namespace

void write_exr_image(const std::filesystem::path& path, const ExrImage& image) {
  expect_writable(image);
  // Packed in memory: the library would not say that a disk is full.
  Imf::StdOSStream bytes;
  {
    Imf::OutputFile file(bytes, header_of(image), 1);
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
      // The library reads through a pointer that is not const.
      auto* const values = const_cast<char*>(reinterpret_cast<const char*>(image.values[c].data()));
      frame.insert(image.channels[c], Imf::Slice(Imf::FLOAT, values, sizeof(float), sizeof(float) * image.width));
    }
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(image.height));
  }
  write_file(path, bytes.str());
}

ExrImage read_exr_image(const std::filesystem::path& path) {
  (void)open_input(path);  // for its answer to what is missing, a folder or may not be read
  try {
    return ImageReader(path).read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw input_error(path.string(), 0, "", "is not a complete OpenEXR file (" + std::string(error.what()) + ")");
  }
}

}  // namespace goniofit
