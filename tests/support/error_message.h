#pragma once
// What an action complains of.

#include <string>

#include "support/error.h"

namespace goniofit::test {

/// The message of the Error that `action` throws, with its exit status in front: "2 m.json: /surface/slope: ...". "no
/// error" where it throws none.
template <class Action>
[[nodiscard]] std::string error_message(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ' ' + error.what();
  }
  return "no error";
}

}  // namespace goniofit::test
