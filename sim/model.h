// Owns a Verilated model of any top module.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "verilated.h"

namespace raygate {

/// Returns a context whose models start with zeros in all registers or, with
/// RAYGATE_RANDOM_RESET=<seed> in the environment, with random bits, as in hardware. No result may
/// depend on these initial values.
inline std::unique_ptr<VerilatedContext> make_context() {
  auto context = std::make_unique<VerilatedContext>();
  if (const char* seed = std::getenv("RAYGATE_RANDOM_RESET")) {
    context->randReset(2);
    context->randSeed(static_cast<int>(std::strtol(seed, nullptr, 10)));
  }
  return context;
}

/// One Verilated model `Top` (a class that Verilator made) in a context of its own, so that each
/// thread may have one. Ports are reached by `model->port`. Must not be copied or moved: a waveform
/// and the context keep its address.
template <class Top>
class Model {
 public:
  /// Evaluates the model once, because the first evaluation ignores a clock edge. RAYGATE_MUTANT in
  /// the environment selects the fault to inject in a netlist with faults (sim/mutate).
  Model() {
    if constexpr (requires(Top top) { top.mutant; }) {
      if (const char* fault = std::getenv("RAYGATE_MUTANT")) {
        top_->mutant = static_cast<std::uint16_t>(std::strtoul(fault, nullptr, 10));
      }
    }
    top_->eval();
  }
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  // Verilator 5.006 can hang if a model is destroyed while the thread's context is another model's.
  ~Model() {
    Verilated::threadContextp(context_.get());
    top_->final();
    top_.reset();
  }

  Top* operator->() { return top_.get(); }
  const Top* operator->() const { return top_.get(); }
  Top& operator*() { return *top_; }
  const Top& operator*() const { return *top_; }
  VerilatedContext& context() { return *context_; }

  /// Updates the outputs from the inputs. A combinational top needs no other call.
  void eval() { top_->eval(); }

  /// Simulates one clock cycle: a rising edge with the present inputs, then the falling edge. The
  /// outputs read afterwards are those between this rising edge and the next one.
  ///
  /// The falling edge changes only Verilator's record of the clock's level. If the model's
  /// ___024root.h (Verilator 5.006) is included, clock() writes this record itself: that is faster.
  void clock() {
    if constexpr (requires(Top top) { top.rootp->__Vtrigrprev__TOP__clk_i = 0; }) {
      edge(1);
      top_->rootp->__Vtrigrprev__TOP__clk_i = 0;
      top_->clk_i = 0;
    } else {
      edge(1);
      edge(0);
    }
  }

  /// Simulates half a clock cycle: the clock changes to `level`.
  void edge(bool level) {
    top_->clk_i = level;
    top_->eval();
    clocks_ += level;
  }

  /// Asserts and releases the asynchronous, active-low reset, without a clock edge.
  void reset() {
    top_->clk_i = 0;
    top_->rst_ni = 1;
    top_->eval();
    top_->rst_ni = 0;
    top_->eval();
    top_->rst_ni = 1;
    top_->eval();
  }

  /// Rising clock edges since construction.
  [[nodiscard]] std::uint64_t clocks() const { return clocks_; }

 private:
  std::unique_ptr<VerilatedContext> context_ = make_context();
  std::unique_ptr<Top> top_ = std::make_unique<Top>(context_.get(), "");
  std::uint64_t clocks_ = 0;
};

}  // namespace raygate
