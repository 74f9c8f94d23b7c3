#include "host/cli/checkpointer.h"

#include <algorithm>
#include <exception>

#include "host/cli/output_files.h"
#include "host/cli/process.h"

namespace raygate {
namespace {

/// Whether nothing has been rendered, or nothing but misses.
bool is_empty(const Film& film) {
  return std::ranges::all_of(film.color, [](const glm::vec4& color) { return color.a == 0.0f; });
}

std::string going_on(const OutputOptions& outputs) {
  return "--resume " + outputs.exr->string() + " goes on from there";
}

}  // namespace

std::string listed(const std::vector<std::filesystem::path>& paths) {
  std::string text;
  for (const auto& path : paths) text += (text.empty() ? "" : ", ") + path.string();
  return text;
}

void Checkpointer::save_urgently(const Film& film) {
  if (!outputs_.exr) return;
  OutputOptions film_alone = outputs_;
  film_alone.png.reset();
  film_alone.false_colors.clear();
  save(film, film_alone);
  bar_.erase();
  print_warning("a rank may have died; " + going_on(all_));
}

void Checkpointer::end_interrupted(const Film& film) const {
  const int signal = interruption();
  if (is_empty(film)) {
    throw Interrupted(signal, "no file was changed");
  }
  write(film, outputs_);
  OutputOptions pictures = outputs_;
  pictures.stats.reset();
  const bool goes_on = (film.keeps_sums || all_.frames > 0) && outputs_.exr;
  throw Interrupted(signal, "wrote what there was: " + listed(pictures.paths()) +
                                (goes_on ? "; " + going_on(all_) : ""));
}

void Checkpointer::save(const Film& film, const OutputOptions& outputs) {
  std::string trouble;
  try {
    write(film, outputs);
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty() && trouble != last_trouble_) {
    bar_.erase();
    print_warning(trouble + "; the render goes on, and the next save tries again");
  }
  last_trouble_ = trouble;
}

void Checkpointer::write(const Film& film, const OutputOptions& outputs) const {
  ExrMetadata metadata = metadata_;
  metadata.partial = true;
  for (AtomicFile& file : stage_files(outputs, film, metadata, threads_).files) file.commit();
}

}  // namespace raygate
