// The processes that share a run, "ranks" as MPI calls them, and what they tell each other.
#pragma once

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>

namespace raygate {

/// What a message is about.
enum class About : int {
  kRoom,     ///< to rank 0: how many more tiles the sender has room for
  kTile,     ///< from rank 0: samples of a tile to trace
  kTraced,   ///< to rank 0: what came of them
  kFinish,   ///< from rank 0: all is traced
  kCounts,   ///< to rank 0: the sender's statistics
  kNext,     ///< to rank 0: asks for the number of the next job
  kJob,      ///< from rank 0: that number
  kFailure,  ///< to rank 0: the Ending of a sender that cannot go on
  kEnd,      ///< from rank 0: the run is over, whatever the others are doing
};

struct Message {
  int from;
  About about;
  std::string bytes;
};

/// The bytes of a value, and back. Ranks are the same program on like machines.
template <class T>
[[nodiscard]] std::string bytes_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <class T>
[[nodiscard]] T value_of(const std::string& bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  std::memcpy(&value, bytes.data(), std::min(bytes.size(), sizeof value));
  return value;
}

/// What a process says last that cannot go on: its exit status, and a line that says why.
struct Ending {
  int status;
  std::string line;
};

/// What rank 0 throws when another one has ended so.
class RankFailure : public std::runtime_error {
 public:
  explicit RankFailure(const Message& message)
      : std::runtime_error("rank " + std::to_string(message.from) + ": " +
                           message.bytes.substr(sizeof(int))),
        status_(value_of<int>(message.bytes)) {}
  /// The bytes of a message about it.
  [[nodiscard]] static std::string message_of(const Ending& ending) {
    return bytes_of(ending.status) + ending.line;
  }
  [[nodiscard]] int status() const { return status_; }

 private:
  int status_;
};

/// All ranks of a run, as one of them sees them. Rank 0 hands out work, gathers and writes. From
/// one thread at a time.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;  ///< leaves, if that has not been done

  [[nodiscard]] virtual int index() const { return 0; }  ///< of this one
  [[nodiscard]] virtual int count() const { return 1; }
  /// This one's share of the machine's processors.
  [[nodiscard]] virtual unsigned processors() const {
    return std::max(1u, std::thread::hardware_concurrency());
  }

  /// Returns at once; messages from one rank to another arrive in their order.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): those that have others keep the bytes
  virtual void send(int /*to*/, About /*about*/, std::string /*bytes*/) {}
  /// The next message, if one is there. Of those that are never handed on, throws: on rank 0
  /// RankFailure for kFailure; on others RunIsOver for kEnd.
  [[nodiscard]] virtual std::optional<Message> receive() { return std::nullopt; }

  /// Nothing is shared from now on. Rank 0 says so to the others, which wait for that; all wait for
  /// all. A rank that dies later harms nobody.
  virtual void leave() {}
};

/// What ends a rank's work when rank 0 has ended.
struct RunIsOver : std::exception {};

/// The ranks of this run: those that mpirun or Slurm started, or this process alone. Throws
/// InputError where a launcher has started several, and this program was built without MPI or with
/// another one than the launcher's.
[[nodiscard]] std::unique_ptr<Ranks> join_ranks();

}  // namespace raygate
