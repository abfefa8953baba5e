#include "bench/timing/machine.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace slipstick::bench {
namespace {

constexpr long kMebibyte = 1L << 20;

std::string key_of(const std::string& cpuinfo, long cache_bytes) {
  std::istringstream text(cpuinfo);
  return machine_key(text, cache_bytes);
}

std::string intel(const std::string& name, int cpus) {
  std::string text;
  for (int i = 0; i < cpus; ++i) {
    text += "processor\t: " + std::to_string(i) +
            "\nvendor_id\t: GenuineIntel\ncpu family\t: 6\nmodel\t\t: 143\n" + "model name\t: " + name +
            "\nstepping\t: 8\n\n";
  }
  return text;
}

TEST(MachineKey, SaysProcessorCountAndCache) {
  EXPECT_EQ(key_of(intel("Intel(R) Xeon(R) Processor", 2), 105 * kMebibyte),
            "intel-xeon-family6-model143-2cpus-cache-105m");
}

TEST(MachineKey, LeavesTheNominalFrequencyOut) {
  EXPECT_EQ(key_of(intel("Intel(R) Core(TM) i7-8700 CPU @ 3.20GHz", 12), 12 * kMebibyte),
            "intel-core-i7-8700-family6-model143-12cpus-cache-12m");
}

TEST(MachineKey, OfAMDKeepsItsSeries) {
  EXPECT_EQ(
      key_of("processor : 0\ncpu family : 25\nmodel : 33\nmodel name : AMD Ryzen 9 5950X 16-Core Processor\n",
             32 * kMebibyte),
      "amd-ryzen-9-5950x-family25-model33-1cpus-cache-32m");
}

TEST(MachineKey, OfARMIsItsImplementerAndPart) {
  EXPECT_EQ(key_of("processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n\nprocessor\t: 1\n", 0),
            "unknown-implementer0x41-part0xd0c-2cpus");
}

TEST(MachineKey, OfThisMachineHoldsNothingButWordsAndDashes) {
  const std::string key = machine_key();
  EXPECT_EQ(key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << key;
  EXPECT_EQ(key, machine_key());
  EXPECT_EQ(key.find("--"), std::string::npos) << key;
}

}  // namespace
}  // namespace slipstick::bench
