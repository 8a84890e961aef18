// One libFuzzer program a reader; GONIOFIT_FUZZ_READER is the reader's name.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  goniofit::fuzz::GONIOFIT_FUZZ_READER({reinterpret_cast<const char*>(data), size});
  return 0;
}
