#include "host/scene/io/obj_reader.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

#include "host/base/threads.h"
#include "host/scene/io/obj_chunk.h"
#include "host/scene/io/tokens.h"

namespace raygate {

// Lines and vertices are counted before they are read, so that each part knows its line numbers and
// what indices below 0 mean.
void ObjReader::read(const LoadOptions& options) {
  const std::size_t most = options.threads > 1 ? std::size_t{4} * options.threads : 1;
  std::vector<ObjChunk> parts;
  for (TextLines& part : lines().split(most, options.chunk_size))
    parts.emplace_back(std::move(part));
  if (parts.size() > 1) {
    std::vector<ObjChunk::Counts> counts(parts.size());
    for_each_on_threads(options.threads, parts.size(),
                        [&](std::size_t i) { counts[i] = parts[i].count(); });
    ObjChunk::Counts before;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].begin_after(before);
      before.lines += counts[i].lines;
      before.mesh += counts[i].mesh;
    }
  }
  for_each_on_threads(options.threads, parts.size(), [&](std::size_t i) { parts[i].read(); });
  for (ObjChunk& part : parts) take(part);
}

void ObjReader::take(ObjChunk& part) {
  const std::size_t first = mesh_.face_count();
  std::size_t done = first;
  mesh_.append(std::move(part.mesh()));
  for (const ObjChunk::Rest& rest : part.rest()) {
    assign_faces(done, first + rest.faces);
    done = first + rest.faces;
    lines().go_to(rest.line);
    read_statement(rest.statement);
  }
  assign_faces(done, mesh_.face_count());
  part.rethrow();
}

/// Gives the faces from `begin` to `end` the material and the object that are in force.
void ObjReader::assign_faces(std::size_t begin, std::size_t end) {
  if (begin == end) return;
  if (!object_is_known_) {
    const std::string between = object_.empty() || group_.empty() ? "" : "/";
    const std::string name = object_ + between + group_;
    object_number_ = objects_.number_of(name.empty() ? "default" : name);
    object_is_known_ = true;
  }
  mesh_.assign_faces(begin, end, material_number_, object_number_, smoothing_group_);
}

void ObjReader::read_statement(std::string_view statement) {
  const std::string_view keyword = take_token(statement);
  if (keyword == "g") {
    set_group(statement);
  } else if (keyword == "o") {
    object_ = statement;
    object_is_known_ = false;
  } else if (keyword == "s") {
    set_smoothing(statement);
  } else if (keyword == "usemtl") {
    use_material(std::string(statement));
  } else if (keyword == "mtllib") {
    mtl_.load_library(statement);
  } else if (keyword == "v") {
    warn_once(keyword, "vertex weights are ignored: they concern curves alone");
  } else {
    warn_once(keyword,
              std::string(keyword) + " statements are ignored: only polygons are rendered");
  }
}

/// "a b" may be one group or two: it is one name here.
void ObjReader::set_group(std::string_view names) {
  group_.clear();
  for (std::string_view name = take_token(names); !name.empty(); name = take_token(names)) {
    group_.append(group_.empty() ? "" : " ").append(name);
  }
  object_is_known_ = false;
}

void ObjReader::set_smoothing(std::string_view words) {
  const std::string_view word = take_token_before_comment(words);
  const char* const end = word.data() + word.size();
  smoothing_group_ = 0;
  const auto [rest, error] = std::from_chars(word.data(), end, smoothing_group_);
  if (word == "off" || (error == std::errc() && rest == end)) return;
  smoothing_group_ = word == "on" ? 1 : 0;
  if (word != "on") {
    warn_once("s",
              "s " + in_quotes(word) + ", expected the number of a group or off; taken as off");
  }
}

void ObjReader::use_material(const std::string& name) {
  material_number_ = materials_.number_of(name);
  if (material_number_ == places_.size()) places_.push_back(lines().place());
}

}  // namespace raygate
