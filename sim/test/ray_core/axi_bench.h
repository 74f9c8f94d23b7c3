// Test bench of ray_core_axi: accesses registers, simulates memory with pauses, takes results.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "hw/ray_core/registers.h"
#include "sim/core_port.h"
#include "sim/test/ray_core/pixel_grid.h"

namespace raygate::test {

constexpr std::uint32_t kSeed = 20261122;
constexpr std::uint64_t kBase = 0x9234'5678'8000'0000, kResults = 0x0123'4567'89AB'CFC0;

/// `Top`: Verilator's class of ray_core_axi, with an AXI4 port as wide as m_axi_rdata.
template <class Top>
class AxiBench : public testing::Test {
 protected:
  static constexpr unsigned kWords = sizeof(Top::m_axi_rdata) / 4, kBeats = 16 / kWords;
  using Words = std::array<std::uint32_t, kWords>;  // the data of one beat

  AxiBench() {
    model_->s_axil_awvalid = model_->s_axil_wvalid = model_->s_axil_arvalid = 0;
    model_->s_axil_bready = model_->s_axil_rready = 1;
    model_->s_axil_wstrb = 15;
    model_->m_axi_arready = model_->m_axi_rvalid = 0;
    model_->m_axi_rresp = 0;
    model_->m_axi_rlast = 0;
    model_->m_axi_awready = model_->m_axi_wready = model_->m_axi_bvalid = 0;
    model_->m_axi_bresp = 0;
    model_->ray_valid_i = model_->m_axis_tready = 0;
    model_.reset();
  }

  /// Simulates a clock of the core, of memory and of the user of results.
  void clock() {
    const bool is_reading = !beats_.empty() || model_->m_axi_rvalid != 0;
    const bool is_writing = bursts_ != answered_;
    model_->m_axi_arready = random_() % 4 != 0 && !(is_single_ && is_writing);
    model_->m_axis_tready = random_() % 4 != 0 && takes_results_;
    model_->m_axi_awready = random_() % 4 != 0 && !(is_single_ && (is_reading || is_writing));
    model_->m_axi_wready = random_() % 4 != 0;
    if (model_->m_axi_bvalid == 0 && unanswered_ != 0 && random_() % 4 == 0) {
      model_->m_axi_bvalid = 1;
    }
    if (model_->m_axi_rvalid == 0 && !beats_.empty() && random_() % 4 != 0) {
      model_->m_axi_rid = beats_.front().id;
      std::memcpy(&model_->m_axi_rdata, &beats_.front().data, sizeof(Words));
      model_->m_axi_rlast = beats_.front().last;
      model_->m_axi_rvalid = 1;
      beats_.pop_front();
    }
    model_.eval();
    if (is_single_ && model_->m_axi_arvalid != 0 && random_() % 2 != 0) model_->m_axi_awready = 0;
    if (is_single_ && (model_->m_axi_awvalid & model_->m_axi_awready) != 0)
      model_->m_axi_arready = 0;
    stalled_ = model_->m_axi_rvalid > model_->m_axi_rready ? stalled_ + 1 : 0;
    ASSERT_LT(stalled_, 64) << "RREADY is low; at most 32 requests wait for lines";
    if ((model_->m_axi_arvalid & model_->m_axi_arready) != 0) {
      const std::uint64_t line = (model_->m_axi_araddr - kBase) / 64;
      ASSERT_LT(line, image_.lines().size());
      ASSERT_EQ(model_->m_axi_arlen, kBeats - 1);
      ASSERT_EQ(4 * kWords, 1u << model_->m_axi_arsize);
      ASSERT_EQ(model_->m_axi_arburst, 1);
      ASSERT_EQ(model_->m_axi_arprot, 2);
      ASSERT_EQ(model_->m_axi_arcache, 3);
      for (unsigned beat = 0; beat < kBeats; ++beat) {
        Beat& sent = beats_.emplace_back(Beat{model_->m_axi_arid, {}, beat + 1 == kBeats});
        std::copy_n(&image_.lines()[line].words[kWords * beat], kWords, sent.data.begin());
      }
    }
    const bool beat_taken = (model_->m_axi_rvalid & model_->m_axi_rready) != 0;
    const bool ray_taken = (model_->ray_valid_i & model_->ray_ready_o) != 0;
    if ((model_->m_axis_tvalid & model_->m_axis_tready) != 0) {
      std::array<std::uint32_t, 8> record;
      std::memcpy(record.data(), &model_->m_axis_tdata, sizeof record);
      results_.push_back(result_of(record));
      ASSERT_EQ(model_->m_axis_tlast, results_.back().kind == CoreResult::Kind::kEnd);
    }
    if ((model_->m_axi_awvalid & model_->m_axi_awready) != 0) {
      ASSERT_EQ(model_->m_axi_awaddr, kResults + 32 * bursts_++);
      ASSERT_EQ(model_->m_axi_awid, 0);
      ASSERT_EQ(model_->m_axi_awlen, 8 / kWords - 1);
      ASSERT_EQ(4 * kWords, 1u << model_->m_axi_awsize);
      ASSERT_EQ(model_->m_axi_awburst, 1);
      ASSERT_EQ(model_->m_axi_awprot, 2);
      ASSERT_EQ(model_->m_axi_awcache, 3);
    }
    if ((model_->m_axi_wvalid & model_->m_axi_wready) != 0) {
      ASSERT_EQ(model_->m_axi_wstrb + 1, 1 << 4 * kWords);
      ASSERT_EQ(model_->m_axi_wlast, written_.size() % 8 == 8 - kWords);
      Words data;
      std::memcpy(&data, &model_->m_axi_wdata, sizeof data);
      written_.insert(written_.end(), data.begin(), data.end());
    }
    unanswered_ = std::min<std::size_t>(bursts_, written_.size() / 8) - answered_;
    const bool answered = model_->m_axi_bvalid != 0;
    model_.clock();
    if (answered) {
      ++answered_;
      --unanswered_;
      model_->m_axi_bvalid = 0;
    }
    if (beat_taken) model_->m_axi_rvalid = 0;
    if (ray_taken) model_->ray_valid_i = 0;
  }

  /// Writes a register. Returns the response: 0, or 2 if the write is refused.
  unsigned write(std::uint32_t address, std::uint32_t data) {
    model_->s_axil_awaddr = address;
    model_->s_axil_wdata = data;
    model_->s_axil_awvalid = model_->s_axil_wvalid = 1;
    EXPECT_EQ(model_->s_axil_awready & model_->s_axil_wready, 1);
    clock();
    model_->s_axil_awvalid = model_->s_axil_wvalid = 0;
    clock();
    EXPECT_EQ(model_->s_axil_bvalid, 1);
    return model_->s_axil_bresp;
  }
  void write(std::uint32_t address, const glm::vec3& vector) {
    for (int k = 0; k < 3; ++k) {
      write(address + 4 * static_cast<unsigned>(k), std::bit_cast<std::uint32_t>(vector[k]));
    }
  }

  /// Sends results to a buffer in memory with room for `records` results; 0: to the stream.
  void use_buffer(std::uint32_t records) {
    write(RAYGATE_RESULTS, static_cast<std::uint32_t>(kResults) | 31);
    write(RAYGATE_RESULTS_HIGH, static_cast<std::uint32_t>(kResults >> 32));
    write(RAYGATE_LENGTH, records);
  }

  std::uint32_t read(std::uint32_t address) {
    model_->s_axil_araddr = address;
    model_->s_axil_arvalid = 1;
    clock();
    model_->s_axil_arvalid = 0;
    const std::uint32_t data = model_->s_axil_rdata;
    EXPECT_EQ(model_->s_axil_rvalid, 1);
    EXPECT_EQ(model_->s_axil_rresp, 0);
    clock();
    return data;
  }

  /// Sets the memory's base, and a camera in front of the scene: pixels 0.05 apart at distance 1.
  void look() {
    write(0x014, static_cast<std::uint32_t>(kBase));
    write(0x018, static_cast<std::uint32_t>(kBase >> 32));
    write(0x030, kEye);
    write(0x040, kGrid.first);
    write(0x050, kGrid.right);
    write(0x060, kGrid.down);
  }

  /// Draws `side` x `side` pixels. ends_ then has the pixels' final results.
  void draw(std::uint32_t side) {
    results_.clear();
    ends_.clear();
    write(0x00C, 2);
    write(0x010, 15);
    write(0x024, side << 16 | side);
    ASSERT_EQ(write(0x004, 1), 0u);
    for (int n = 0; model_->interrupt_o == 0; ++n) {
      ASSERT_LT(n, 100'000);
      clock();
    }
    while ((read(0x008) & 4) != 0) clock();  // waits for prefetched lines
    for (const CoreResult& result : results_) {
      if (result.kind == CoreResult::Kind::kEnd) ends_[result.tag] = result;
    }
    ASSERT_EQ(ends_.size(), side * side);
  }

  /// Returns the reference model's final result for this pixel.
  static CoreResult reference(const MemoryImage& image, std::uint32_t pixel) {
    const CoreRay ray{.ray = {kEye, kGrid.direction(static_cast<std::uint16_t>(pixel),
                                                    static_cast<std::uint16_t>(pixel >> 16))}};
    std::vector<CoreResult> results;
    ReferenceCore().trace(image.lines(), {&ray, 1}, results);
    return results.back();
  }

  /// Traces rays that start on triangles but do not name them as sources; many have doubts. Every
  /// fourth ray has t_max before all hits. Stops after `clocks` clocks, or when all rays end.
  void trace(std::size_t rays, int clocks) {
    test::Random random;
    std::size_t sent = 0, ended = 0, seen = 0;
    for (int n = 0; n < clocks && ended < rays; ++n) {
      if (sent < rays && model_->ray_valid_i == 0) {
        Ray ray = test::some_rays(test::bodies(), random, 1).front();
        const auto corners =
            bvh_.corners_of(static_cast<std::uint32_t>(sent % bvh_.primitive_count()));
        ray.origin = glm::vec3((corners[0] + corners[1] + corners[2]) / 3.0);
        const float t_max = sent % 4 == 0 ? 0.001f : std::numeric_limits<float>::infinity();
        put_ray(*model_, {.ray = ray, .t_max = t_max, .tag = static_cast<std::uint32_t>(sent++)});
      }
      clock();
      if (HasFatalFailure()) return;
      for (; seen < results_.size(); ++seen) {
        ended += results_[seen].kind == CoreResult::Kind::kEnd;
      }
    }
  }

  static constexpr glm::vec3 kEye{0.25f, 0.3f, 2.5f};
  static constexpr PixelGrid kGrid{glm::vec3(-0.6f, 0.5f, -1.0f), glm::vec3(0.05f, 0.001f, 0.0f),
                                   glm::vec3(0.0f, -0.05f, 0.002f)};

  struct Beat {
    std::uint32_t id;
    Words data;
    bool last;
  };

  Bvh bvh_{test::scene_of(test::bodies())};
  MemoryImage image_{bvh_};
  bool is_single_ = false;     // memory accepts a write only while no read is open, and vice versa
  bool takes_results_ = true;  // whether the user takes results from the stream
  int stalled_ = 0;            // clocks for which a beat has waited for RREADY
  std::mt19937 random_{kSeed};
  Model<Top> model_;
  std::deque<Beat> beats_;
  std::size_t bursts_ = 0, answered_ = 0, unanswered_ = 0;  // numbers of bursts with results
  std::vector<std::uint32_t> written_;
  std::vector<CoreResult> results_;
  std::map<std::uint32_t, CoreResult> ends_;  // by pixel
};

}  // namespace raygate::test
