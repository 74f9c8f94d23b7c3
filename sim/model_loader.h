// Simulated models in files of their own, which are built where they are first asked for.
#pragma once

namespace raygate {

/// A model in the build folder's sim/models/<name>.so, which CMake's target <name>.so builds.
struct ModelFile {
  const char* name;
  const char* what;  ///< in words: "the simulated ray core"
  int seconds;       ///< that two cores take to build it, roughly
};

/// The function `make_model` of the model's file. A file that is missing is built first, by one
/// process if several ask for it, with a line on standard error. Throws InputError where it can't
/// be built. For any number of threads at once.
[[nodiscard]] void* load_model(const ModelFile& file);

/// As a function of that type, which is the one of the file's source (sim/models).
template <class Function>
[[nodiscard]] Function* load_model(const ModelFile& file) {
  return reinterpret_cast<Function*>(load_model(file));
}

}  // namespace raygate
