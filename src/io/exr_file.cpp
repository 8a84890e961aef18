// The OpenEXR side of exr_table.h. Nothing of OpenEXR, its exceptions included, leaves this file.

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "io/exr_table.h"
#include "io/line_reader.h"
#include "io/material_io.h"
#include "support/error.h"
#include "support/output_file.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::string_view format_name = "goniofit-brdf-table";
constexpr int format_version = 1;
constexpr std::size_t longest_channel_name = 255;  // of the file format
constexpr int most_parts = 1024;

std::string components_text(EffectSet components) {
  std::string out;
  for (const Effect e : all_effects) {
    if (components.has(e)) out += (out.empty() ? "" : " ") + std::string(name_of(e));
  }
  return out;
}

// ---- writing

std::string part_name(double theta_i_deg) {
  char name[32];
  std::snprintf(name, sizeof name, "theta_i_%09.5f", theta_i_deg);
  return name;
}

// Every number of the material, so that nobody needs to read JSON for one.
void insert_parameters(Imf::Header& header, const Material& material) {
  Surface surface = material.surface;
  for (const std::string_view name : surface_parameter_names) {
    const std::optional<double> value = *surface.find(name);
    if (value) header.insert("goniofit." + std::string(name), Imf::DoubleAttribute(*value));
  }
  for (const auto& [name, value] : material.parameters) {
    if (value) header.insert("goniofit." + name, Imf::DoubleAttribute(*value));
  }
  std::set<std::string> coefficients;
  for (const MaterialChannel& channel : material.channels) {
    for (const Coefficient c : all_coefficients) {
      if (channel.coefficient(c)) coefficients.emplace(name_of(c));
    }
    for (const auto& [name, value] : channel.peer_k) coefficients.insert(name);
  }
  for (const std::string& name : coefficients) {
    std::vector<float> by_channel;
    for (const MaterialChannel& channel : material.channels) {
      by_channel.push_back(
          static_cast<float>(channel.coefficient(name).value_or(std::numeric_limits<double>::quiet_NaN())));
    }
    header.insert("goniofit." + name, Imf::FloatVectorAttribute(by_channel));
  }
}

Imf::Header common_header(const Material& material, const BrdfTable& table) {
  const int size = static_cast<int>(table.size);
  Imf::Header header(size, size);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setType(Imf::SCANLINEIMAGE);
  for (const std::string& channel : table.channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  header.insert("goniofit.format", Imf::StringAttribute(std::string(format_name)));
  header.insert("goniofit.version", Imf::IntAttribute(format_version));
  header.insert("goniofit.name", Imf::StringAttribute(table.name));
  header.insert("goniofit.material", Imf::StringAttribute(to_json(material)));
  header.insert("goniofit.components", Imf::StringAttribute(components_text(material.components)));
  header.insert("goniofit.channels", Imf::StringVectorAttribute(table.channels));
  header.insert("goniofit.interpolation_rms", Imf::DoubleAttribute(table.interpolation_rms));
  header.insert("goniofit.interpolation_max", Imf::DoubleAttribute(table.interpolation_max));
  header.insert("goniofit.model", Imf::StringAttribute(material.model));
  insert_parameters(header, material);
  header.insert(
      "goniofit.mapping",
      Imf::StringAttribute("BRDF in 1/sr. Part: incidence angle theta_i_deg, phi_i = 0. Pixel centre: direction to "
                           "the viewer in the Shirley-Chiu concentric square, z = 1 - r^2, x right and y down; the "
                           "retro side is right, the mirror direction left of the centre. Interpolate bilinearly, "
                           "and linearly in theta_i_deg."));
  header.insert("goniofit.left_out",
                Imf::StringAttribute(material.components.has(Effect::coh)
                                         ? "coh: the mirror cone is narrower than a pixel, see goniofit.material"
                                         : ""));
  return header;
}

void expect_writable(const std::filesystem::path& path, const BrdfTable& table) {
  for (const std::string& channel : table.channels) {
    if (channel.size() > longest_channel_name) {
      throw usage_error("cannot write " + path.string() + ": OpenEXR takes channel names of up to 255 bytes, not " +
                        in_quotes(channel));
    }
  }
}

void write_images(Imf::OStream& stream, const std::vector<Imf::Header>& headers, const BrdfTable& table) {
  Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
      // A slice serves reading and writing alike, hence is not const; writePixels only reads.
      auto* pixels = const_cast<float*>(table.values[i][c].data());
      frame.insert(table.channels[c], Imf::Slice::Make(Imf::FLOAT, pixels, headers[i].dataWindow()));
    }
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(frame);
    part.writePixels(static_cast<int>(table.size));
  }
}

// In memory: OpenEXR writes its last bytes in a destructor, which could not report a full disk.
std::string packed(const Material& material, const BrdfTable& table) {
  std::vector<Imf::Header> headers;
  for (const double theta_i : table.theta_i_deg) {
    Imf::Header& header = headers.emplace_back(common_header(material, table));
    header.setName(part_name(theta_i));
    header.insert("theta_i_deg", Imf::DoubleAttribute(theta_i));
  }
  Imf::StdOSStream stream;
  write_images(stream, headers, table);
  return stream.str();
}

// ---- reading

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path)
      : source_(path.string()), file_bytes_(std::filesystem::file_size(path)), file_(path.c_str(), 0) {}

  BrdfTable read() {
    read_shared(file_.header(0));
    expect_plausible_size();
    for (int part = 0; part < file_.parts(); ++part) read_part(part);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw input_error(source_, 0, "", what); }

  template <class Attribute>
  const auto& attribute(const Imf::Header& header, const std::string& name) const {
    const auto* found = header.findTypedAttribute<Attribute>(name);
    if (found == nullptr)
      fail("attribute " + name + " is missing or of another type, expected a table written by goniofit");
    return found->value();
  }

  double error_attribute(const Imf::Header& header, const std::string& name) const {
    const double value = attribute<Imf::DoubleAttribute>(header, name);
    if (!(value >= 0.0) || std::isinf(value))
      fail("attribute " + name + " is " + shortest(value) + ", expected at least 0");
    return value;
  }

  void read_shared(const Imf::Header& header) {
    const std::string& format = attribute<Imf::StringAttribute>(header, "goniofit.format");
    if (format != format_name)
      fail("attribute goniofit.format is " + in_quotes(format) + ", expected " + in_quotes(format_name));
    const int version = attribute<Imf::IntAttribute>(header, "goniofit.version");
    if (version != format_version) {
      fail("attribute goniofit.version is " + std::to_string(version) + ", expected " + std::to_string(format_version));
    }
    table_.name = attribute<Imf::StringAttribute>(header, "goniofit.name");
    table_.channels = attribute<Imf::StringVectorAttribute>(header, "goniofit.channels");
    table_.interpolation_rms = error_attribute(header, "goniofit.interpolation_rms");
    table_.interpolation_max = error_attribute(header, "goniofit.interpolation_max");
    const auto width = static_cast<std::int64_t>(header.dataWindow().max.x) - header.dataWindow().min.x + 1;
    if (width < 2 || width > static_cast<std::int64_t>(largest_table_size)) {
      fail("images are " + std::to_string(width) + " pixels wide, expected 2 to " + std::to_string(largest_table_size));
    }
    table_.size = static_cast<std::size_t>(width);
  }

  // Before memory is taken for them: what is claimed must be within bounds and within what deflate could pack.
  void expect_plausible_size() const {
    constexpr std::size_t best_deflate_ratio = 1032;
    if (file_.parts() > most_parts) fail("has " + std::to_string(file_.parts()) + " parts, expected at most 1024");
    if (table_.channels.empty()) fail("has no channels, expected at least one");
    const std::size_t images = static_cast<std::size_t>(file_.parts()) * table_.channels.size();
    const std::size_t per_image = table_.size * table_.size;
    if (images > most_table_values / per_image) fail("claims more than 1 GiB of values, expected less");
    if (images * per_image * sizeof(float) / best_deflate_ratio > file_bytes_)
      fail("claims more values than it can hold");
  }

  void expect_part(const Imf::Header& header, const std::string& part) const {
    const int last = static_cast<int>(table_.size) - 1;
    const Imath::Box2i window = header.dataWindow();
    if (window.min != Imath::V2i(0, 0) || window.max != Imath::V2i(last, last)) {
      fail(part + "is not " + std::to_string(table_.size) + " x " + std::to_string(table_.size) +
           " pixels as the first");
    }
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE) fail(part + "is no scan line image");
    std::size_t count = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++count) {
      const bool listed = std::find(table_.channels.begin(), table_.channels.end(), c.name()) != table_.channels.end();
      if (!listed) fail(part + "has a channel " + in_quotes(c.name()) + " that goniofit.channels does not list");
      const bool full_float =
          c.channel().type == Imf::FLOAT && c.channel().xSampling == 1 && c.channel().ySampling == 1;
      if (!full_float) fail(part + "channel " + in_quotes(c.name()) + " is not of 32-bit floats, one a pixel");
    }
    if (count != table_.channels.size()) fail(part + "lacks a channel that goniofit.channels lists");
  }

  void read_part(int index) {
    const Imf::Header& header = file_.header(index);
    const std::string part = "part " + std::to_string(index) + ": ";
    expect_part(header, part);
    if (!file_.partComplete(index)) fail(part + "is not complete");
    const double theta_i = attribute<Imf::DoubleAttribute>(header, "theta_i_deg");
    const double before = table_.theta_i_deg.empty() ? -1.0 : table_.theta_i_deg.back();
    if (!(theta_i >= 0.0 && theta_i < 90.0 && theta_i > before)) {
      fail(part + "theta_i_deg is " + shortest(theta_i) + ", expected ascending angles from 0 to below 90");
    }
    table_.theta_i_deg.push_back(theta_i);
    read_images(index, header);
    for (const std::vector<float>& image : table_.values.back()) {
      const bool good = std::all_of(image.begin(), image.end(), [](float v) { return v >= 0.0F && std::isfinite(v); });
      if (!good) fail(part + "has a value that is negative or not finite");
    }
  }

  void read_images(int index, const Imf::Header& header) {
    auto& images = table_.values.emplace_back(table_.channels.size(), std::vector<float>(table_.size * table_.size));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < images.size(); ++c) {
      frame.insert(table_.channels[c], Imf::Slice::Make(Imf::FLOAT, images[c].data(), header.dataWindow()));
    }
    Imf::InputPart part(file_, index);
    part.setFrameBuffer(frame);
    part.readPixels(0, static_cast<int>(table_.size) - 1);
  }

  std::string source_;
  std::uintmax_t file_bytes_;
  Imf::MultiPartInputFile file_;
  BrdfTable table_;
};

}  // namespace

void write_exr(const std::filesystem::path& path, const Material& material, const BrdfTable& table) {
  expect_writable(path, table);
  write_file(path, packed(material, table));
}

BrdfTable read_exr(const std::filesystem::path& path) {
  (void)open_input(path);  // for its answer to what is missing, a folder or may not be read
  try {
    return TableReader(path).read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw input_error(path.string(), 0, "", "is not a complete OpenEXR file (" + std::string(error.what()) + ")");
  }
}

}  // namespace goniofit
