// Who started this process, as its environment says.
#pragma once

namespace raygate {

/// Whether a launcher of MPI programs did: mpirun, or Slurm's srun by PMI or PMIx.
[[nodiscard]] bool is_launched();

/// How many processes the launcher says that it started; 0 where it says nothing.
[[nodiscard]] int launched_count();

/// Which of them this is, from 0; 0 where it says nothing.
[[nodiscard]] int launched_index();

/// Takes out of the environment what the launcher has put there, for programs that this one starts.
void forget_launcher();

}  // namespace raygate
