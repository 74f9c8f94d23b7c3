#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

constexpr std::size_t kHeader = 80, kStart = kHeader + 4, kFacet = 50, kNormal = 12;

/// Adds a facet with three vertices of its own.
void add_facet(const std::array<glm::dvec3, 3>& corners, std::size_t line, MeshBuilder& mesh,
               std::int32_t& positions) {
  std::array<FileCorner, 3> face;
  for (std::size_t k = 0; k < 3; ++k) {
    mesh.add_position(corners[k]);
    face[k].position = ++positions;
  }
  mesh.add_face(face, line);
}

void read_binary(const std::string& name, std::string_view bytes, std::size_t facets,
                 MeshBuilder& mesh) {
  if (facets > std::size_t{std::numeric_limits<std::int32_t>::max()} / 3) {
    throw InputError(name + ": " + std::to_string(facets) + " facets, expected at most 715827882");
  }
  std::int32_t positions = 0;
  for (std::size_t i = 0; i < facets; ++i) {
    const char* at = bytes.data() + kStart + i * kFacet + kNormal;
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& corner : corners) {
      for (int axis = 0; axis < 3; ++axis, at += sizeof(float)) {
        corner[axis] = number_at<float>(at);
        if (!std::isfinite(corner[axis])) {
          throw InputError(name + ": facet " + std::to_string(i + 1) +
                           " has a coordinate that is not a finite number");
        }
      }
    }
    add_facet(corners, 0, mesh, positions);
  }
}

/// Returns whether the next word equals `word`, ignoring case.
bool is_next(std::string_view word, const TokenReader& tokens) {
  return std::ranges::equal(word, tokens.peek(), [](char small, char letter) {
    return letter == small || (letter >= 'A' && letter <= 'Z' && letter - 'A' + 'a' == small);
  });
}

/// Takes the next word, which must equal `word`, ignoring case.
void expect(std::string_view word, TokenReader& tokens) {
  if (is_next(word, tokens)) {
    (void)tokens.take();
  } else {
    tokens.expect(word);
  }
}

/// Takes "endWORD" or "end WORD".
void expect_end(const std::string& word, TokenReader& tokens) {
  if (is_next("end", tokens)) {
    (void)tokens.take();
    expect(word, tokens);
  } else {
    expect("end" + word, tokens);
  }
}

/// Reads solids (solid NAME, facets, endsolid NAME), which become one; names may have several
/// words. Warns if the last endsolid is missing.
void read_ascii(const std::string& name, std::string_view text, MeshBuilder& mesh,
                std::vector<std::string>& warnings) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  TokenReader tokens(name, text);
  std::int32_t positions = 0;
  while (!tokens.at_end()) {
    expect("solid", tokens);
    tokens.skip_line();
    while (is_next("facet", tokens)) {
      const std::size_t line = tokens.line();
      expect("facet", tokens);
      expect("normal", tokens);
      for (int axis = 0; axis < 3; ++axis) (void)tokens.take();  // often nan
      expect("outer", tokens);
      expect("loop", tokens);
      std::array<glm::dvec3, 3> corners;
      for (glm::dvec3& corner : corners) {
        expect("vertex", tokens);
        for (int axis = 0; axis < 3; ++axis) corner[axis] = tokens.number("a coordinate");
      }
      expect_end("loop", tokens);
      expect_end("facet", tokens);
      if (positions > std::numeric_limits<std::int32_t>::max() - 3) {
        tokens.fail("too many facets");
      }
      add_facet(corners, line, mesh, positions);
    }
    if (tokens.at_end() && positions > 0) {
      warnings.push_back(name + ": the file ends without endsolid, perhaps too soon");
      break;
    }
    expect_end("solid", tokens);
    tokens.skip_line();
  }
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
    read_binary(name, bytes, facets, mesh);  // may be followed by other data
    if (const std::size_t more = (bytes.size() - length) / kFacet; more > 0) {
      scene.warnings.push_back(name + ": room for " + std::to_string(more) + " facets after the " +
                               std::to_string(facets) + " that its header counts, ignored");
    }
  } else if (!has_zero) {
    read_ascii(name, bytes, mesh, scene.warnings);
  } else {
    throw InputError(name + ": found " + std::to_string(bytes.size()) + " bytes, expected " +
                     std::to_string(length) + " for the " + std::to_string(facets) +
                     " facets that the header of a binary STL file counts");
  }
  mesh.build_plain(options, scene);
  scene.is_usually_z_up = true;
  return scene;
}

}  // namespace raygate
