// libFuzzer target: arbitrary bytes as an OpenEXR image, for `merge` and `--resume`.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/base/input_error.h"
#include "host/film/exr.h"
#include "host/film/film.h"
#include "host/film/merge.h"

namespace {

/// Calls work(), which may throw an InputError of one line.
template <class Work>
void refusable(const Work& work) {
  try {
    work();
  } catch (const raygate::InputError& refused) {
    if (std::string(refused.what()).find('\n') != std::string::npos) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace raygate;
  static const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                            ("raygate_fuzz_" + std::to_string(getpid()) + ".exr");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  refusable([&] { (void)read_exr(file); });
  refusable([&] {
    const FilmFile whole = merge({{"a.exr", read_film(file)}});
    // A film that was read can be written; encode_exr reads it back.
    (void)encode_exr(whole.film, whole.metadata, 2);
  });
  return 0;
}
