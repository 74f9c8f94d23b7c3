#include "Vfp_adder_bf16.h"
#include "Vfp_adder_f16.h"
#include "Vfp_adder_f32.h"
#include "Vfp_adder_f8.h"
#include "Vfp_compare_bf16.h"
#include "Vfp_compare_f16.h"
#include "Vfp_compare_f32.h"
#include "Vfp_compare_f8.h"
#include "Vfp_divider_bf16.h"
#include "Vfp_divider_f16.h"
#include "Vfp_divider_f32.h"
#include "Vfp_divider_f8.h"
#include "Vfp_multiplier_bf16.h"
#include "Vfp_multiplier_f16.h"
#include "Vfp_multiplier_f32.h"
#include "Vfp_multiplier_f8.h"
#include "sim/fp/float_cores.h"
#include "sim/model.h"

namespace raygate {
namespace {

template <class Multiplier, class Adder, class Divider, class Compare>
class RtlFloatCores : public FloatCores {
 public:
  explicit RtlFloatCores(FloatFormat format) : format_(format) {}

  FloatFormat format() const override { return format_; }

  FloatResult run(FloatOp op, std::uint32_t a, std::uint32_t b, RoundingMode rounding,
                  Tininess tininess) override {
    switch (op) {
      case FloatOp::kAdd:
      case FloatOp::kSub:
        adder_->subtract_i = op == FloatOp::kSub;
        return arithmetic(adder_, a, b, rounding, tininess);
      case FloatOp::kMul:
        return arithmetic(multiplier_, a, b, rounding, tininess);
      case FloatOp::kDiv:
        return arithmetic(divider_, a, b, rounding, tininess);
      default:
        return comparison(op, a, b);
    }
  }

 private:
  template <class Core>
  static FloatResult arithmetic(Core& core, std::uint32_t a, std::uint32_t b, RoundingMode rounding,
                                Tininess tininess) {
    core->a_i = a;
    core->b_i = b;
    core->rounding_mode_i = static_cast<std::uint8_t>(rounding);
    core->tininess_after_i = static_cast<std::uint8_t>(tininess);
    core.eval();
    return {core->result_o, core->flags_o};
  }

  FloatResult comparison(FloatOp op, std::uint32_t a, std::uint32_t b) {
    compare_->a_i = a;
    compare_->b_i = b;
    compare_->signaling_i = op != FloatOp::kEq;
    compare_.eval();
    const bool less = compare_->less_o != 0 && op != FloatOp::kEq;
    const bool equal = compare_->equal_o != 0 && op != FloatOp::kLt;
    return {less || equal ? 1u : 0u, compare_->flags_o};
  }

  FloatFormat format_;
  Model<Multiplier> multiplier_;
  Model<Adder> adder_;
  Model<Divider> divider_;
  Model<Compare> compare_;
};

}  // namespace

std::unique_ptr<FloatCores> rtl_float_cores(FloatFormat format) {
  if (format == kBinary32) {
    return std::make_unique<
        RtlFloatCores<Vfp_multiplier_f32, Vfp_adder_f32, Vfp_divider_f32, Vfp_compare_f32>>(format);
  }
  if (format == kBinary16) {
    return std::make_unique<
        RtlFloatCores<Vfp_multiplier_f16, Vfp_adder_f16, Vfp_divider_f16, Vfp_compare_f16>>(format);
  }
  if (format == kBfloat16) {
    return std::make_unique<
        RtlFloatCores<Vfp_multiplier_bf16, Vfp_adder_bf16, Vfp_divider_bf16, Vfp_compare_bf16>>(
        format);
  }
  if (format == kFloat8) {
    return std::make_unique<
        RtlFloatCores<Vfp_multiplier_f8, Vfp_adder_f8, Vfp_divider_f8, Vfp_compare_f8>>(format);
  }
  return nullptr;
}

}  // namespace raygate
