// Ranks: the processes that share a run, as MPI calls them, what they tell each other, and the jobs
// that they take one after the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
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

/// The bytes of a value, and back from those that a message begins with. Ranks are the same program
/// on like machines: throws InputError where there are fewer bytes than that.
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

/// What a process says last that cannot go on: its exit status, and a line that says why.
struct Ending {
  int status;
  std::string line;
};

/// What rank 0 throws when another one has ended so.
class RankFailure : public std::runtime_error {
 public:
  explicit RankFailure(const Message& message)
      : RankFailure(message, value_of<int>(message.bytes)) {}
  /// The bytes of a message about it.
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

/// Runs `work` of a rank other than 0. Of what it throws, as `ending` puts it, rank 0 hears, and
/// has the last word: to the user, and about the exit status.
void run_rank(Ranks& ranks, const std::function<void()>& work,
              const std::function<Ending(std::exception_ptr)>& ending);

/// Jobs 0 to count - 1: each goes to the rank that asks first. Rank 0 hands the numbers out on a
/// thread of its own while it works on jobs itself. All ranks make one of the same count; nobody
/// else may use `ranks` meanwhile.
class JobQueue {
 public:
  JobQueue(Ranks& ranks, int count) : ranks_(ranks), count_(count) {}
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// A job for this rank; none when all have been begun. On rank 0 not before those of the other
  /// ranks have ended, or one of them could not go on; then throws what receive() does.
  [[nodiscard]] std::optional<int> next();

 private:
  void serve(const std::stop_token& stop);

  Ranks& ranks_;
  int count_;
  std::atomic<int> next_ = 0;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr error_;
  std::jthread server_;  // last: it uses the others
};

/// Whether a launcher of MPI programs did: mpirun, or Slurm's srun by PMI or PMIx.
[[nodiscard]] bool is_launched();

/// How many processes the launcher says that it started; 0 where it says nothing.
[[nodiscard]] int launched_count();

/// Which of them this is, from 0; 0 where it says nothing.
[[nodiscard]] int launched_index();

/// Takes out of the environment what the launcher has put there, for programs that this one starts.
void forget_launcher();

}  // namespace raygate
