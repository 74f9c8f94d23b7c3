// A library to be preloaded (LD_PRELOAD) into the ranks of a run: one of them ends, as by kill -9,
// where it would send or take a message.
//
//   RAYGATE_FAULT_RANK=R, RAYGATE_FAULT_MESSAGE=N    rank R, at its message number N
//   RAYGATE_FAULT_COUNT=FILE    at the end, how many messages rank 0 had
//
// By MPI's profiling interface (MPI 3.1, chapter 14).
#include <mpi.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

long messages = 0;  // MPI_THREAD_SERIALIZED: one thread at a time

int rank() {
  int index = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &index);
  return index;
}

void count() {
  ++messages;
  const char* const who = std::getenv("RAYGATE_FAULT_RANK");
  const char* const when = std::getenv("RAYGATE_FAULT_MESSAGE");
  if (who == nullptr || when == nullptr) return;
  if (std::atol(when) == messages && std::atoi(who) == rank()) std::raise(SIGKILL);
}

}  // namespace

extern "C" {

int MPI_Isend(const void* bytes, int size, MPI_Datatype type, int to, int tag, MPI_Comm world,
              MPI_Request* request) {
  count();
  return PMPI_Isend(bytes, size, type, to, tag, world, request);
}

int MPI_Mrecv(void* bytes, int size, MPI_Datatype type, MPI_Message* message, MPI_Status* status) {
  count();
  return PMPI_Mrecv(bytes, size, type, message, status);
}

int MPI_Finalize() {
  const char* const file = std::getenv("RAYGATE_FAULT_COUNT");
  if (file != nullptr && rank() == 0) {
    std::FILE* const out = std::fopen(file, "w");
    if (out == nullptr) std::abort();
    std::fprintf(out, "%ld", messages);
    std::fclose(out);
  }
  return PMPI_Finalize();
}
}
