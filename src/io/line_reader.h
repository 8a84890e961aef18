#pragma once
// Lines of a text input through one buffer of fixed size: byte-order mark, CRLF and a missing last newline are no
// business of the callers, and no input, however broken, makes the reader take more memory.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace goniofit {

/// Opens an input. Throws Error (bad_input) where it is missing, a folder or may not be read.
[[nodiscard]] std::ifstream open_input(const std::filesystem::path& path);

/// The whole of an input of at most `limit` bytes. Throws Error: bad_input beyond the limit, system where reading
/// fails.
[[nodiscard]] std::string read_whole(std::istream& in, const std::string& source, std::size_t limit);

/// Bytes from the current position to the end, where the input can tell (files can, pipes cannot).
[[nodiscard]] std::optional<std::uint64_t> remaining_bytes(std::istream& in);

class LineReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{1} << 20;  ///< 1 MiB, its end not counted

  LineReader(std::istream& in, std::string source);

  /// The next line without its end; false where there is none. The view is good until the next call. Throws Error:
  /// bad_input for a line longer than `longest_line` and for UTF-16, system where reading fails.
  [[nodiscard]] bool next(std::string_view& line);
  /// Of the line last returned, from 1.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  [[nodiscard]] const std::string& source() const noexcept { return source_; }
  /// Bytes of the input up to the end of that line.
  [[nodiscard]] std::uint64_t consumed() const noexcept { return read_ - (end_ - begin_); }

 private:
  [[nodiscard]] bool fill();
  [[nodiscard]] std::string_view take(std::size_t length, std::size_t with_end);

  std::istream& in_;
  std::string source_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // what is read and not yet returned
  std::size_t number_ = 0;
  static constexpr std::size_t capacity = longest_line + 1;
  std::uint64_t read_ = 0;  // bytes of the input so far
};

}  // namespace goniofit
