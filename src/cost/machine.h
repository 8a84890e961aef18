#pragma once
// What a time was measured on.

#include <string>

namespace goniofit {

/// The processor as it names itself, and how many of it: "Intel(R) Xeon(R) ... x 2"; "unknown processor" where the
/// system does not tell.
[[nodiscard]] std::string machine_name();

}  // namespace goniofit
