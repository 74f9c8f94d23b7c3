// GltfFile: the JSON, the buffers and the images of a glTF 2.0 file, with checked access to them.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/io/json_reader.h"

namespace raygate {

/// Returns an extension of a part of the file; null if it is missing.
[[nodiscard]] const Json& extension(const Json& part, const char* name);

/// A .gltf or .glb file with its buffers.
class GltfFile {
 public:
  /// Warnings are appended to `warnings`, which must outlive this object. Throws InputError if a
  /// file cannot be read, is not glTF 2.0 or requires an extension that is not read.
  GltfFile(const std::filesystem::path& file, std::vector<std::string>& warnings);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns the paths of all files that were read so far.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Returns the total size of these files in bytes.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// Throws InputError, "file: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// Adds the warning "file: what" unless there is one.
  void warn_once(const std::string& what) { add_warning(name_ + ": " + what); }
  /// Calls `read`. An InputError becomes a warning that ends in `instead`.
  template <class Read>
  void optionally(const char* instead, const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      add_warning(error.what() + std::string(", ") + instead);
    }
  }

  [[nodiscard]] const Json& json() const { return json_; }
  /// Returns a list of the file, such as "nodes"; null if it has none.
  [[nodiscard]] const Json& list(const char* name) const { return member(json_, name); }
  /// Returns an extension of the whole file; null if it has none.
  [[nodiscard]] const Json& extension(const char* name) const {
    return raygate::extension(json_, name);
  }
  /// Returns element `index` of a list. Throws InputError, which calls it `what`, if there is none.
  [[nodiscard]] const Json& at(const Json& list, int index, const char* what) const;
  [[nodiscard]] const Json& accessor(int index) const {
    return at(list("accessors"), index, "accessor");
  }
  /// Returns the number of elements of an accessor.
  [[nodiscard]] std::size_t count(int accessor) const;

  /// Returns the first `width` components of each element of an accessor, which may be infinite or
  /// NaN. Throws InputError if they cannot be read.
  [[nodiscard]] std::vector<double> numbers(int accessor, int width, const char* what) const;
  /// Returns the numbers of an optional attribute of a primitive with this number of vertices.
  /// Returns an empty list for accessor -1 and, with a warning, for an accessor that cannot be
  /// read.
  [[nodiscard]] std::vector<double> optional_numbers(int accessor, int width, const char* what,
                                                     std::size_t vertices);
  /// Returns the numbers of an accessor of indices.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor) const;
  /// Returns the bytes of an image file. Throws InputError if it has none.
  [[nodiscard]] std::string_view picture_bytes(int image);

 private:
  struct Component;
  std::string_view read(const std::filesystem::path& file);
  /// Returns the bytes of a data URI or of a file beside this one; nullopt if there are none.
  std::optional<std::string_view> load(const std::string& uri);
  void add_warning(const std::string& warning);
  [[nodiscard]] const Component& component_of(const Json& part, const std::string& place) const;
  [[nodiscard]] std::vector<double> elements(int accessor, std::size_t width, const char* what,
                                             bool are_indices) const;
  /// Returns the bytes of a buffer view. Throws InputError, which names `place`, if it has none or
  /// is not within its buffer.
  [[nodiscard]] std::string_view stored(int buffer_view, const std::string& place) const;
  /// Returns `count` elements of `width` numbers, without gaps, at an accessor or a part of a
  /// sparse one. Throws InputError if they exceed their buffer view.
  [[nodiscard]] std::vector<double> stored_numbers(const Json& part, const Component& component,
                                                   std::size_t width, std::size_t count,
                                                   const std::string& place) const;
  [[noreturn]] void fail_extension(const std::string& extension) const;

  std::string name_;
  std::filesystem::path folder_;
  std::vector<std::string>& warnings_;
  std::vector<std::filesystem::path> files_;
  std::size_t bytes_ = 0;
  Json json_;
  std::deque<std::string> contents_;  // of files and data URIs
  std::vector<std::string_view> buffers_;
};

/// Returns the transform from a node's coordinates to its parent's.
[[nodiscard]] glm::dmat4 local_matrix(const Json& node);

}  // namespace raygate
