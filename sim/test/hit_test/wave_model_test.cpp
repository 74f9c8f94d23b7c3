// A waveform contains the hierarchy and all simulated clocks.
#include "sim/wave_model.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "Vhit_test_unit_open.h"

namespace raygate {
namespace {

TEST(WaveModel, WritesEveryClock) {
  const auto path = std::filesystem::temp_directory_path() / "raygate_wave_model_test.vcd";
  {
    WaveModel<Vhit_test_unit_open> unit;
    unit.record(path.string());
    unit.reset();
    for (int clock = 0; clock < 5; ++clock) unit.clock();
  }
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  const std::string wave = text.str();
  EXPECT_NE(wave.find("$timescale 1ns $end"), std::string::npos);
  EXPECT_NE(wave.find("accumulator_q [31:0] $end"), std::string::npos);
  EXPECT_NE(wave.find("$scope module u_multiplier $end"), std::string::npos);
  for (int clock = 1; clock <= 5; ++clock) {
    EXPECT_NE(wave.find("\n#" + std::to_string(10 * clock) + "\n"), std::string::npos);
    EXPECT_NE(wave.find("\n#" + std::to_string(10 * clock + 5) + "\n"), std::string::npos);
  }
  EXPECT_EQ(wave.find("\n#60\n"), std::string::npos);
}

TEST(WaveModel, RefusesAFileThatCannotBeWritten) {
  WaveModel<Vhit_test_unit_open> unit;
  EXPECT_THROW(unit.record("/nowhere/at/all.vcd"), InputError);
}

}  // namespace
}  // namespace raygate
