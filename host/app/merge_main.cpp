// The program `merge`: joins parts of a picture that were rendered separately.
#include <string>
#include <vector>

#include "host/app/console.h"
#include "host/app/options.h"
#include "host/app/outputs.h"
#include "host/base/input_error.h"
#include "host/film/film.h"
#include "host/film/merge.h"

namespace raygate {
namespace {

constexpr const char* kAbout = R"(Usage: ./merge PART.exr... -o NAME [options]

Makes one picture of parts that `render` made of it: ranges of its samples
(--samples A:B), crops (--crop) with their sums (--channels sums), or both. The
picture is bit for bit what one run would have rendered.

  ./render scenes/cornell.obj --spp 64 --samples 0:32 -o a.exr
  ./render scenes/cornell.obj --spp 64 --samples 32:64 -o b.exr
  ./merge a.exr b.exr -o cornell
)";

constexpr const char* kFooter =
    R"(The EXR keeps its sums with --channels sums, and while samples are missing.

Exit status: 0 done; 2 the parts do not make a picture, or the command line or
an output cannot be used.)";

int run(const std::vector<std::string>& words) {
  OutputOptions options;
  OptionTable table(kAbout, kFooter);
  table.group("Options");
  add_picture_options(table, options);
  const CommandLine line = table.parse(words);
  if (line.plain.empty() || table.given("output").empty()) {
    throw InputError("expected parts of a picture and -o NAME (see --help)");
  }
  name_outputs(table, line.plain.front(), options);
  require_distinct(options.paths(),
                   std::vector<std::filesystem::path>(line.plain.begin(), line.plain.end()));
  for (const auto& path : options.paths()) require_writable(path);

  std::vector<NamedFilm> films;
  films.reserve(line.plain.size());
  for (const std::string& part : line.plain) films.emplace_back(part, read_film(part));
  FilmFile whole = merge(std::move(films));
  const bool is_part = whole.film.keeps_sums;
  whole.film.keeps_sums = is_part || options.channels.sums;
  StagedFiles ready = stage_files(options, whole.film, whole.metadata);
  for (AtomicFile& file : ready.files) file.commit();
  print("wrote " + listed(options.pictures()) + ": samples " +
        to_string(samples_of(whole.metadata)) +
        (is_part ? ", of a picture that has more\n" : "\n"));
  return 0;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) { return raygate::run_main(argc, argv, raygate::run); }
