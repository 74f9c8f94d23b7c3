#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

constexpr std::size_t kHeader = 80, kStart = kHeader + 4, kFacet = 50, kNormal = 12;

/// Three corners of their own.
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

/// solid NAME, facets, endsolid NAME; names may have several words. More than one solid is one.
void read_ascii(const std::string& name, std::string_view bytes, MeshBuilder& mesh) {
  TokenReader tokens(name, bytes);
  std::int32_t positions = 0;
  while (!tokens.at_end()) {
    tokens.expect("solid");
    tokens.skip_line();
    while (tokens.peek() == "facet") {
      const std::size_t line = tokens.line();
      tokens.expect("facet");
      tokens.expect("normal");
      for (int axis = 0; axis < 3; ++axis) (void)tokens.take();  // often nan
      tokens.expect("outer");
      tokens.expect("loop");
      std::array<glm::dvec3, 3> corners;
      for (glm::dvec3& corner : corners) {
        tokens.expect("vertex");
        for (int axis = 0; axis < 3; ++axis) corner[axis] = tokens.number("a coordinate");
      }
      tokens.expect("endloop");
      tokens.expect("endfacet");
      if (positions > std::numeric_limits<std::int32_t>::max() - 3) {
        tokens.fail("too many facets");
      }
      add_facet(corners, line, mesh, positions);
    }
    tokens.expect("endsolid");
    tokens.skip_line();
  }
}

}  // namespace

Scene load_stl(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file), name = file.string();
  MeshBuilder mesh(name);
  // A binary file may begin with "solid", too: its length says what it is.
  const std::size_t facets =
      bytes.size() < kStart ? 0 : number_at<std::uint32_t>(bytes.data() + kHeader);
  const std::size_t length = kStart + facets * kFacet;
  const bool is_solid = std::string_view(bytes).starts_with("solid");
  if (bytes.size() == length || (!is_solid && facets > 0 && bytes.size() > length)) {
    read_binary(name, bytes, facets, mesh);  // perhaps with something after it
  } else if (is_solid) {
    read_ascii(name, bytes, mesh);
  } else {
    throw InputError(name + ": not an STL file: " + std::to_string(bytes.size()) +
                     " bytes, expected \"solid\" at its start or " + std::to_string(length) +
                     " bytes for its " + std::to_string(facets) + " facets");
  }
  Scene scene;
  mesh.build_plain(options, scene);
  scene.is_usually_z_up = true;
  return scene;
}

}  // namespace raygate
