#include "io/line_reader.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "support/error.h"

namespace goniofit {

namespace {

constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
constexpr std::string_view utf16_mark_little = "\xFF\xFE";
constexpr std::string_view utf16_mark_big = "\xFE\xFF";

Error unreadable(const std::filesystem::path& path, int error_number) {
  return input_error(path.string(), 0, "", std::string("cannot be read: ") + std::strerror(error_number));
}

[[noreturn]] void fail_reading(const std::string& source) {
  throw system_error("cannot read " + source + ": " + std::strerror(errno != 0 ? errno : EIO));
}

}  // namespace

std::ifstream open_input(const std::filesystem::path& path) {
  std::error_code ignored;
  // A folder opens like a file and fails only when it is read.
  if (std::filesystem::is_directory(path, ignored)) throw unreadable(path, EISDIR);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw unreadable(path, errno != 0 ? errno : EIO);
  return in;
}

std::string read_whole(std::istream& in, const std::string& source, std::size_t limit) {
  std::string content;
  std::vector<char> chunk(std::size_t{1} << 16);
  errno = 0;
  while (in.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), in.gcount() > 0) {
    content.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
    if (content.size() > limit) {
      throw input_error(source, 0, "", "is larger than " + std::to_string(limit) + " bytes; expected a smaller file");
    }
  }
  if (in.bad()) fail_reading(source);
  return content;
}

std::optional<std::uint64_t> remaining_bytes(std::istream& in) {
  const std::istream::pos_type here = in.tellg();
  if (here == std::istream::pos_type(-1) || !in.seekg(0, std::ios::end)) {
    in.clear();
    return std::nullopt;
  }
  const std::istream::pos_type end = in.tellg();
  in.seekg(here);
  return end > here ? static_cast<std::uint64_t>(end - here) : std::uint64_t{0};
}

LineReader::LineReader(std::istream& in, std::string source)
    : in_(in), source_(std::move(source)), buffer_(std::make_unique_for_overwrite<char[]>(capacity)) {}

bool LineReader::fill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == capacity) {
    throw input_error(source_, number_ + 1, "", "the line is longer than 1 MiB; expected text with one reading a line");
  }
  errno = 0;
  in_.read(buffer_.get() + end_, static_cast<std::streamsize>(capacity - end_));
  if (in_.bad()) fail_reading(source_);
  end_ += static_cast<std::size_t>(in_.gcount());
  read_ += static_cast<std::uint64_t>(in_.gcount());
  return in_.gcount() > 0;
}

std::string_view LineReader::take(std::size_t length, std::size_t with_end) {
  std::string_view line(buffer_.get() + begin_, length);
  begin_ += with_end;
  if (++number_ == 1) {
    if (line.starts_with(utf16_mark_little) || line.starts_with(utf16_mark_big)) {
      throw input_error(source_, 1, "", "the text is UTF-16; expected UTF-8");
    }
    if (line.starts_with(utf8_mark)) line.remove_prefix(utf8_mark.size());
  }
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* const start = buffer_.get() + begin_;
    const std::size_t held = end_ - begin_;
    if (const void* found = std::memchr(start + searched, '\n', held - searched)) {
      const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - start);
      line = take(length, length + 1);
      return true;
    }
    searched = held;
    if (fill()) continue;
    if (held == 0) return false;
    line = take(held, held);
    return true;
  }
}

}  // namespace goniofit
