#pragma once
// A text with a part of it changed: how a good file becomes a bad one.

#include <gtest/gtest.h>

#include <string>

namespace goniofit::test {

/// The first occurrence of `from`, which must be there.
[[nodiscard]] inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "there is no " << from;
    return text;
  }
  return text.replace(at, from.size(), to);
}

}  // namespace goniofit::test
