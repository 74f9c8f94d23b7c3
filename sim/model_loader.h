// Simulated models in files of their own, which are built on first use.
#pragma once

namespace raygate {

/// A model in the build folder's sim/models/<name>.so, which CMake's target <name>.so builds.
struct ModelFile {
  const char* name;
  const char* what;  ///< in words: "the simulated ray core"
  int seconds;       ///< rough build time on two cores
};

/// Returns the function `make_model` of the model's file. If the file is missing, builds it first
/// and reports this on standard error. Only one process at a time builds. Throws InputError if the
/// file cannot be built. Thread-safe.
[[nodiscard]] void* load_model(const ModelFile& file);

/// Returns `make_model` as a `Function`, which must be its type in sim/models.
template <class Function>
[[nodiscard]] Function* load_model(const ModelFile& file) {
  return reinterpret_cast<Function*>(load_model(file));
}

}  // namespace raygate
