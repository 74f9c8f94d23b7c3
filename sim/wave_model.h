// A model whose signals can be written to a file.
#pragma once

#include <memory>
#include <string>

#include "host/base/input_error.h"
#include "sim/model.h"
#include "verilated_vcd_c.h"

namespace raygate {

/// A Model of a `Top` that was Verilated with OPEN (sim/verilate.cmake). After `record`, every
/// clock is written to a waveform: a value change dump (VCD) of 10 ns per clock.
template <class Top>
class WaveModel : public Model<Top> {
 public:
  /// Starts the file at `path`. Throws InputError if the file cannot be written.
  void record(const std::string& path) {
    this->context().traceEverOn(true);
    this->context().timeunit(-9);
    this->context().timeprecision(-9);
    wave_ = std::make_unique<VerilatedVcdC>();
    (**this).trace(wave_.get(), 99);  // 99: the whole hierarchy
    wave_->open(path.c_str());
    if (!wave_->isOpen()) throw InputError(path + ": can't be written");
  }

  /// Like Model::clock. In the waveform, inputs change 2 ns before the edge that samples them.
  void clock() {
    if (wave_) {
      this->eval();
      wave_->dump(10 * this->clocks() + 8);
    }
    this->edge(1);
    if (wave_) wave_->dump(10 * this->clocks());
    this->edge(0);
    if (wave_) wave_->dump(10 * this->clocks() + 5);
  }

 private:
  std::unique_ptr<VerilatedVcdC> wave_;  // closes its file when destroyed
};

}  // namespace raygate
