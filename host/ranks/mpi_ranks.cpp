// Ranks of a program built with MPI.
#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <list>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/ranks/ranks.h"

namespace raygate {
namespace {

constexpr std::chrono::milliseconds kPoll{1};  // polling interval while waiting for messages

/// Returns this rank's share of the processors that ranks of its machine may use together.
unsigned count_processors() {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int count = 0;
  MPI_Comm_size(machine, &count);
  cpu_set_t own;
  CPU_ZERO(&own);
  sched_getaffinity(0, sizeof own, &own);
  std::vector<cpu_set_t> all(static_cast<std::size_t>(count));
  MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, machine);
  MPI_Comm_free(&machine);
  const auto sharing = std::ranges::count_if(
      all, [&](const cpu_set_t& other) { return CPU_EQUAL(&own, &other) != 0; });
  return static_cast<unsigned>(std::max<std::ptrdiff_t>(1, CPU_COUNT(&own) / sharing));
}

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &index_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Type_contiguous(kUnit, MPI_BYTE, &unit_);
    MPI_Type_commit(&unit_);
    processors_ = count_processors();
  }

  ~MpiRanks() override { MpiRanks::leave(); }

  /// Finalizes when no rank sends any more: the others wait for kEnd from rank 0.
  void leave() override {
    if (std::exchange(has_left_, true)) return;
    for (int rank = 1; index_ == 0 && rank < count_; ++rank) MpiRanks::send(rank, About::kEnd, {});
    while (index_ == 0 ? !sending_.empty() : !is_over_) {
      if (index_ != 0) is_over_ = taken().value_or(Message{}).about == About::kEnd;
      forget_sent();
      std::this_thread::sleep_for(kPoll);
    }
    MPI_Finalize();
  }

  [[nodiscard]] int index() const override { return index_; }
  [[nodiscard]] int count() const override { return count_; }
  [[nodiscard]] unsigned processors() const override { return processors_; }

  void send(int to, About about, std::string bytes) override {
    const std::uint64_t size = bytes.size(), units = (size + sizeof size + kUnit - 1) / kUnit;
    bytes.resize(kUnit * units);
    std::memcpy(bytes.data() + bytes.size() - sizeof size, &size, sizeof size);
    Sending& sending = sending_.emplace_back(std::move(bytes));
    MPI_Isend(sending.bytes.data(), static_cast<int>(units), unit_, to, static_cast<int>(about),
              MPI_COMM_WORLD, &sending.request);
    forget_sent();
  }

  [[nodiscard]] std::optional<Message> receive() override {
    forget_sent();
    std::optional<Message> message = taken();
    if (!message) return message;
    if (message->about == About::kEnd) {
      is_over_ = true;
      throw RunIsOver();
    }
    if (message->about == About::kFailure) throw RankFailure(*message);
    return message;
  }

 private:
  /// Unit of message lengths in bytes, as MPI counts with int. Messages are padded to whole units;
  /// the last eight bytes hold the length.
  static constexpr std::size_t kUnit = 64;

  struct Sending {
    explicit Sending(std::string all) : bytes(std::move(all)) {}
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void forget_sent() {
    std::erase_if(sending_, [](Sending& sending) {
      int done = 0;
      MPI_Test(&sending.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }

  /// Returns a complete message. Does not wait for the rest of one, as its sender may have died.
  std::optional<Message> taken() {
    int there = 0;
    if (!coming_) {
      MPI_Message handle = MPI_MESSAGE_NULL;
      MPI_Status status;
      MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &handle, &status);
      if (there == 0) return std::nullopt;
      int units = 0;
      MPI_Get_count(&status, unit_, &units);
      coming_.emplace(status.MPI_SOURCE, static_cast<About>(status.MPI_TAG),
                      std::string(kUnit * static_cast<std::size_t>(units), '\0'));
      MPI_Imrecv(coming_->bytes.data(), units, unit_, &handle, &receiving_);
    }
    MPI_Test(&receiving_, &there, MPI_STATUS_IGNORE);
    if (there == 0) return std::nullopt;
    std::string& bytes = coming_->bytes;
    bytes.resize(number_at<std::uint64_t>(&bytes[bytes.size() - sizeof(std::uint64_t)]));
    return std::exchange(coming_, std::nullopt);
  }

  MPI_Datatype unit_ = MPI_DATATYPE_NULL;
  int index_ = 0, count_ = 1;
  unsigned processors_ = 1;
  bool is_over_ = false, has_left_ = false;
  std::list<Sending> sending_;     // buffers still read by MPI
  std::optional<Message> coming_;  // buffer still written by MPI
  MPI_Request receiving_ = MPI_REQUEST_NULL;
};

}  // namespace

std::unique_ptr<Ranks> join_ranks() {
  if (!is_launched()) return std::make_unique<Ranks>();
  auto ranks = std::make_unique<MpiRanks>();
  const int count = launched_count();
  if (count > ranks->count()) {
    throw InputError("found " + std::to_string(count) + " ranks that know nothing of each other" +
                     ", expected the launcher of the MPI that this program was built with");
  }
  return ranks;
}

}  // namespace raygate
