// Serial link: a board at a serial port, such as synth/boards has them.
#pragma once

#include <filesystem>
#include <vector>

#include "host/intersect/core/linked_core.h"

namespace raygate {

/// Words as four bytes, lowest first, 8N1, 2 Mbaud. Throws InputError, with the port's name, where
/// it can't be opened, and where the board says nothing for kPatience seconds while something is
/// expected of it.
class SerialLink : public WordLink {
 public:
  explicit SerialLink(std::filesystem::path port);
  SerialLink(const SerialLink&) = delete;
  SerialLink& operator=(const SerialLink&) = delete;
  ~SerialLink() override;

  bool send(std::uint32_t word) override;
  std::optional<std::uint32_t> receive() override;
  void wait() override;

 private:
  static constexpr int kPatience = 30;
  static constexpr std::size_t kBuffer = 4096;  ///< bytes that wait to be written

  [[noreturn]] void fail(const std::string& what) const;
  void write_some();
  void read_some();

  std::filesystem::path port_;
  int file_;
  std::vector<unsigned char> out_, in_;
  std::size_t taken_ = 0;  ///< of in_
};

}  // namespace raygate
