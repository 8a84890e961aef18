#include "cost/machine.h"

#include <algorithm>
#include <fstream>
#include <thread>

namespace goniofit {

std::string machine_name() {
  std::string name = "unknown processor";
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    name = line.substr(colon + 2);
    break;
  }
  return name + " x " + std::to_string(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace goniofit
