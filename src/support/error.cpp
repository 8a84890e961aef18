#include "support/error.h"

namespace goniofit {

Error input_error(const std::string& file, std::size_t line, const std::string& column, const std::string& what) {
  std::string message = file;
  if (line > 0) (message += ':') += std::to_string(line);
  message += ": ";
  if (!column.empty()) message.append("column ").append(column).append(": ");
  return {ErrorKind::bad_input, message + what};
}

Error key_error(const std::string& file, const std::string& pointer, const std::string& what) {
  return {ErrorKind::bad_input, file + ": " + (pointer.empty() ? "/" : pointer) + ": " + what};
}

Error usage_error(const std::string& what) { return {ErrorKind::bad_input, what}; }

Error system_error(const std::string& what) { return {ErrorKind::system, what}; }

}  // namespace goniofit
