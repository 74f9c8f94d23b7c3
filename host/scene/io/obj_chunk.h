// ObjChunk: a part of an OBJ file that one thread parses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/text_lines.h"

namespace raygate {

/// Parses vertices and faces. Chunks can be read concurrently. Statements about materials, groups
/// and other files depend on earlier chunks, so they are kept for ObjReader.
class ObjChunk {
 public:
  /// A statement other than a vertex or a face.
  struct Rest {
    std::string statement;
    std::size_t line;
    std::size_t faces;  ///< number of the chunk's faces before it
  };

  explicit ObjChunk(TextLines lines) : lines_(std::move(lines)), mesh_(lines_.file_name()) {}

  /// Numbers of lines and vertices, as counted without parsing numbers.
  struct Counts {
    std::size_t lines = 0;
    MeshBuilder::Counts mesh;
  };
  [[nodiscard]] Counts count() const;
  /// Sets the counts of all earlier chunks. To be called before read().
  void begin_after(const Counts& counts);

  /// Reads v, vt, vn and f. Checks the count of numbers, that those of vertices are finite, and
  /// that no vertex index is 0. Stops at the first error.
  void read();

  [[nodiscard]] MeshBuilder& mesh() { return mesh_; }
  [[nodiscard]] const std::vector<Rest>& rest() const { return rest_; }
  /// Throws the InputError at which read() stopped, if it did.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void read_statement(std::string_view statement);
  std::span<const double> read_numbers(std::string_view keyword, std::string_view words);
  void read_face(std::string_view corners);
  FileCorner read_corner(std::string_view corner) const;
  void keep(std::string_view statement);
  void keep_once(std::string_view keyword);

  TextLines lines_;
  MeshBuilder mesh_;
  std::vector<Rest> rest_;
  std::set<std::string, std::less<>> kept_;  // keywords passed to keep_once()
  std::exception_ptr error_;
  std::array<double, 7> numbers_{};  // of one statement
  std::vector<FileCorner> corners_;  // of one face
};

}  // namespace raygate
