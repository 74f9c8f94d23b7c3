#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

constexpr std::size_t kHeader = 80, kStart = kHeader + 4, kFacet = 50, kNormal = 12;
constexpr std::size_t kMostFacets = std::numeric_limits<std::int32_t>::max() / 3;

/// Adds a face of the last three positions.
void add_facet(MeshBuilder& mesh, std::size_t line) {
  const auto end = static_cast<std::uint32_t>(mesh.counts().positions);
  const FaceCorner face[] = {{end - 3}, {end - 2}, {end - 1}};
  mesh.add_face(face, line);
}

void read_binary(const std::string& name, std::string_view bytes, std::size_t facets,
                 MeshBuilder& mesh) {
  if (facets > kMostFacets) {
    throw InputError(name + ": " + std::to_string(facets) + " facets, expected at most " +
                     std::to_string(kMostFacets));
  }
  for (std::size_t i = 0; i < facets; ++i) {
    const char* at = bytes.data() + kStart + i * kFacet + kNormal;
    for (int corner = 0; corner < 3; ++corner) {
      glm::dvec3 position;
      for (int axis = 0; axis < 3; ++axis, at += sizeof(float)) {
        position[axis] = number_at<float>(at);
        if (!std::isfinite(position[axis])) {
          throw InputError(name + ": facet " + std::to_string(i + 1) +
                           " has a coordinate that is not a finite number");
        }
      }
      mesh.add_position(position);
    }
    add_facet(mesh, 0);
  }
}

/// Takes the remaining words of a line.
void skip_line(std::size_t line, Words& words) {
  while (!words.at_end() && words.line() == line) words.take();
}

/// Takes "endWORD" or "end WORD".
void expect_end(const std::string& word, Words& words) {
  words.take_if("end") ? words.expect(word) : words.expect("end" + word);
}

/// Reads all solids (solid NAME, facets, endsolid NAME) into one mesh. Names may have several
/// words. Returns whether the last solid has its endsolid.
bool read_ascii(Words words, MeshBuilder& mesh) {
  while (!words.at_end()) {
    std::size_t line = words.line();
    words.expect("solid");
    skip_line(line, words);
    for (line = words.line(); words.take_if("facet"); line = words.line()) {
      words.expect("normal");
      for (int axis = 0; axis < 3; ++axis) (void)words.take();  // often nan
      words.expect("outer");
      words.expect("loop");
      for (int corner = 0; corner < 3; ++corner) {
        words.expect("vertex");
        glm::dvec3 position;
        for (int axis = 0; axis < 3; ++axis) position[axis] = words.number("a coordinate");
        mesh.add_position(position);
      }
      expect_end("loop", words);
      expect_end("facet", words);
      if (mesh.face_count() == kMostFacets) words.fail("too many facets");
      add_facet(mesh, line);
    }
    if (words.at_end() && mesh.face_count() > 0) return false;
    line = words.line();
    expect_end("solid", words);
    skip_line(line, words);
  }
  return true;
}

}  // namespace

Scene load_stl(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file), name = file.string();
  MeshBuilder mesh(name);
  Scene scene;
  const std::size_t facets =
      bytes.size() < kStart ? 0 : number_at<std::uint32_t>(bytes.data() + kHeader);
  const std::size_t length = kStart + facets * kFacet;
  // A binary file may also begin with "solid". Unlike text, it has a zero byte near its beginning.
  const bool has_zero = bytes.find('\0') < 1024;
  if (facets > 0 && (bytes.size() == length || (has_zero && bytes.size() > length))) {
    read_binary(name, bytes, facets, mesh);  // other data may follow
    if (const std::size_t more = (bytes.size() - length) / kFacet; more > 0) {
      scene.warnings.push_back(name + ": room for " + std::to_string(more) + " facets after the " +
                               std::to_string(facets) + " that its header counts, ignored");
    }
  } else if (!has_zero) {
    const std::string_view text = bytes, mark = "\xEF\xBB\xBF";  // UTF-8's byte order mark
    if (!read_ascii({name, text.substr(text.starts_with(mark) ? mark.size() : 0), 1}, mesh)) {
      scene.warnings.push_back(name + ": the file ends without endsolid, perhaps too soon");
    }
  } else {
    throw InputError(name + ": found " + std::to_string(bytes.size()) + " bytes, expected " +
                     std::to_string(length) + " for the " + std::to_string(facets) +
                     " facets that the header of a binary STL file counts");
  }
  mesh.build_plain(options, scene);
  scene.up = glm::dvec3(0.0, 0.0, 1.0);
  return scene;
}

}  // namespace raygate
