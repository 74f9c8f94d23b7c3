// A library to be preloaded (LD_PRELOAD) into the ranks of a run: one of them ends, as by kill -9,
// where it would send or take a message.
//
//   RAYGATE_FAULT_RANK=R           rank R, where one of these says
//   RAYGATE_FAULT_MESSAGE=N        at its message number N
//   RAYGATE_FAULT_BYTES=N          in the middle of its first message of N bytes or more
//   RAYGATE_FAULT_COUNT=FILE       at the end, how many messages rank 0 had
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

/// -1: none is.
long number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? -1 : std::atol(text);
}

void end_if(bool is_time) {
  if (is_time && number_in("RAYGATE_FAULT_RANK") == rank()) std::raise(SIGKILL);
}

void count() { end_if(++messages == number_in("RAYGATE_FAULT_MESSAGE")); }

}  // namespace

extern "C" {

int MPI_Isend(const void* bytes, int size, MPI_Datatype type, int to, int tag, MPI_Comm world,
              MPI_Request* request) {
  count();
  const int status = PMPI_Isend(bytes, size, type, to, tag, world, request);
  // Of a long message only the beginning is on its way by now.
  const long least = number_in("RAYGATE_FAULT_BYTES");
  int unit = 0;
  PMPI_Type_size(type, &unit);
  end_if(least >= 0 && long{size} * unit >= least);
  return status;
}

int MPI_Imrecv(void* bytes, int size, MPI_Datatype type, MPI_Message* message,
               MPI_Request* request) {
  count();
  return PMPI_Imrecv(bytes, size, type, message, request);
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
