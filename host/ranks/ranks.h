// Ranks: the processes of a run (in MPI's terms) and their messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>

namespace raygate {

/// The kinds of messages.
enum class About : int {
  kRoom,     ///< to rank 0: number of further tiles that the sender can take
  kTile,     ///< from rank 0: samples of a tile to render
  kTraced,   ///< to rank 0: the rendered tile
  kFinish,   ///< from rank 0: all tiles are complete
  kCounts,   ///< to rank 0: the sender's statistics
  kFailure,  ///< to rank 0: the Ending of a rank that failed
  kEnd,      ///< from rank 0: the run ends at once
};

struct Message {
  int from;
  About about;
  std::string bytes;
};

/// Convert a value to bytes, and back from the start of a message. Ranks run the same program on
/// machines of the same kind. Throws InputError if the message is too short.
[[noreturn]] void throw_short_message(std::size_t found, std::size_t expected);
template <class T>
[[nodiscard]] std::string bytes_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <class T>
[[nodiscard]] T value_of(const std::string& bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (bytes.size() < sizeof(T)) throw_short_message(bytes.size(), sizeof(T));
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// The exit status and message of a process that failed.
struct Ending {
  int status;
  std::string line;
};

/// Thrown on rank 0 when another rank has failed.
class RankFailure : public std::runtime_error {
 public:
  explicit RankFailure(const Message& message)
      : RankFailure(message, value_of<int>(message.bytes)) {}
  [[nodiscard]] static std::string message_of(const Ending& ending) {
    return bytes_of(ending.status) + ending.line;
  }
  [[nodiscard]] int status() const { return status_; }

 private:
  RankFailure(const Message& message, int status)
      : std::runtime_error("rank " + std::to_string(message.from) + ": " +
                           message.bytes.substr(sizeof status)),
        status_(status) {}

  int status_;
};

/// The ranks of a run, as seen by one of them. Rank 0 distributes work, gathers results and writes
/// output. Not thread-safe. The base class is a run of one process.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;  ///< calls leave() if that was not done

  [[nodiscard]] virtual int index() const { return 0; }  ///< of this process
  [[nodiscard]] virtual int count() const { return 1; }
  /// Returns the number of processors for this rank.
  [[nodiscard]] virtual unsigned processors() const {
    return std::max(1u, std::thread::hardware_concurrency());
  }

  /// Sends a message without blocking. Messages between two ranks arrive in order.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): those that have others keep the bytes
  virtual void send(int /*to*/, About /*about*/, std::string /*bytes*/) {}
  /// Returns the next message, or none. Throws RankFailure for kFailure on rank 0, and RunIsOver
  /// for kEnd on others.
  [[nodiscard]] virtual std::optional<Message> receive() { return std::nullopt; }

  /// Ends communication, collectively: all ranks wait for each other. A rank that dies later does
  /// not affect the others.
  virtual void leave() {}
};

/// Thrown on a rank other than 0 when the run has ended.
struct RunIsOver : std::exception {};

/// Returns the ranks of this run: those started by mpirun or Slurm, or this process alone. Throws
/// InputError if a launcher started several processes but the program was built without MPI or with
/// another implementation than the launcher's.
[[nodiscard]] std::unique_ptr<Ranks> join_ranks();

/// Runs `work` on a rank other than 0. If it throws, the Ending that `ending` returns is sent to
/// rank 0, which reports it and determines the exit status.
void run_rank(Ranks& ranks, const std::function<void()>& work,
              const std::function<Ending(std::exception_ptr)>& ending);

/// Returns whether an MPI launcher started this process: mpirun, or Slurm's srun by PMI or PMIx.
[[nodiscard]] bool is_launched();

/// Returns the number of processes as reported by the launcher, or 0.
[[nodiscard]] int launched_count();

/// Returns this process's rank as reported by the launcher, or 0.
[[nodiscard]] int launched_index();

/// Removes the launcher's variables from the environment, for programs that this one starts.
void forget_launcher();

}  // namespace raygate
