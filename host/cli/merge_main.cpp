// The program `merge`: one picture from parts of it, rendered apart.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/cli/command_line.h"
#include "host/cli/output_files.h"
#include "host/cli/output_options.h"
#include "host/cli/process.h"
#include "host/film/merge.h"
#include "host/film/sample_range.h"

namespace raygate {
namespace {

constexpr const char* kHelp =
    R"(Usage: ./merge PART.exr... -o NAME [options]

Makes one picture of parts that `render` made of it: ranges of its samples
(--samples A:B), crops (--crop) with their sums (--channels sums), or both. The
picture is bit for bit what one run would have rendered.

  ./render scenes/cornell.obj --spp 64 --samples 0:32 -o a.exr
  ./render scenes/cornell.obj --spp 64 --samples 32:64 -o b.exr
  ./merge a.exr b.exr -o cornell

  -o, --output NAME          NAME.exr, NAME.png, or NAME for both
  --channels sums            keep the sums in the EXR; kept anyway if samples are
                             still missing
  --exposure STOPS           exposure of the PNG in stops: +1 is twice as bright
  --tone clip|filmic         tone curve of the PNG (clip)
  --false-colour CHANNEL[:LOW:HIGH]=FILE.png   a channel in false colours
  -h, --help; --version

Exit status: 0 done; 2 the parts do not make a picture, or the command line or
an output cannot be used.
)";

int run(int argc, char** argv) {
  std::vector<std::string> parts;
  RawOutputOptions raw;
  CLI::App app("", "merge");
  app.add_option("PART", parts);
  declare_picture_options(app, raw);
  const std::string information =
      read_command_line(app, {argv + 1, argv + argc}, kHelp, "a part that is none");
  if (!information.empty()) {
    print(information);
    return 0;
  }
  if (parts.empty() || raw.output.empty()) {
    throw InputError("expected parts of a picture and -o NAME (see --help)");
  }
  const OutputOptions options = parse_output_options(raw, parts.front());
  const std::vector<std::filesystem::path> inputs(parts.begin(), parts.end());
  require_distinct(options.paths(), inputs);
  for (const auto& path : options.paths()) require_writable(path);

  std::vector<NamedFilm> films;
  films.reserve(parts.size());
  for (const std::string& part : parts) films.emplace_back(part, read_film(part));
  FilmFile whole = merge(std::move(films));
  const bool is_part = std::ranges::find(whole.metadata.options, kSamplesAttribute,
                                         &std::pair<std::string, std::string>::first) !=
                       whole.metadata.options.end();
  whole.film.keeps_sums = options.channels.sums || is_part;
  StagedFiles ready = stage_files(options, whole.film, whole.metadata);
  std::string text;
  for (AtomicFile& file : ready.files) file.commit();
  for (const auto& path : ready.paths) text += (text.empty() ? "" : ", ") + path.string();
  const SampleRange samples = samples_of(whole.metadata);
  print("wrote " + text + ": samples " + to_string(samples) +
        (is_part ? ", of a picture that has more\n" : "\n"));
  flush_standard_output();
  return 0;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  return raygate::run_guarded([&] { return raygate::run(argc, argv); }, 1);
}
