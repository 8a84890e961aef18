#pragma once
// The one exception of the project. It carries what a person needs to mend the cause: which file, which line, which
// column or key, what is wrong and what was expected. It is caught once, in cli/.

#include <cstddef>
#include <stdexcept>
#include <string>

namespace goniofit {

/// What an error means for the program that ran into it; the value is the exit status.
enum class ErrorKind : int {
  failed_result = 1,  ///< the job ran and its result fails (no convergence, a bound of verify missed)
  bad_input = 2,      ///< bad usage or bad input
  system = 3          ///< disk full, unwritable output, memory, a missing external program
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

/// "FILE:LINE: column NAME: what"; `column` may be empty, `line` 0 leaves the line out. Kind: bad_input.
[[nodiscard]] Error input_error(const std::string& file, std::size_t line, const std::string& column,
                                const std::string& what);

/// "FILE: /json/pointer: what" for JSON and TOML. Kind: bad_input.
[[nodiscard]] Error key_error(const std::string& file, const std::string& pointer, const std::string& what);

/// Bad usage that no file is to blame for. Kind: bad_input.
[[nodiscard]] Error usage_error(const std::string& what);

/// "cannot WHAT FILE: reason"; Kind: system.
[[nodiscard]] Error system_error(const std::string& what);

}  // namespace goniofit
