// GltfFile: a glTF 2.0 file as tinygltf parses it, with checked access to its accessors.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {

/// A .gltf or .glb file with its buffers and the bytes of its images. tinygltf is used because
/// Debian 12 has it, under the MIT licence, as one header that is compiled with the sanitizers. It
/// does not check indices and lengths; this class does.
class GltfFile {
 public:
  /// Throws InputError if the file cannot be read, is not glTF 2.0 or requires an extension that is
  /// not read.
  explicit GltfFile(const std::filesystem::path& file);

  [[nodiscard]] const tinygltf::Model& model() const { return model_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns the paths of all files that were read.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Returns the warnings from reading them.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  /// Returns the total size of these files in bytes.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// Throws InputError, "file: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// Appends "file: what" to the warnings unless they contain it.
  void warn_once(const std::string& what, std::vector<std::string>& warnings) const;

  /// Appends the error and, after a comma, what is done instead, unless the warnings contain it.
  static void warn_once(const InputError& error, const char* instead,
                        std::vector<std::string>& warnings);

  /// Returns element `index` of `list`. Throws InputError, which calls it `what`, if there is none.
  template <class T>
  [[nodiscard]] const T& at(const std::vector<T>& list, int index, const char* what) const {
    if (index >= 0 && static_cast<std::size_t>(index) < list.size()) {
      return list[static_cast<std::size_t>(index)];
    }
    fail_index(what, index, list.size());
  }

  /// Returns the first `width` components of each element of an accessor. Throws InputError if they
  /// cannot be read or are not finite.
  [[nodiscard]] std::vector<double> vectors(int accessor, int width, const char* what) const;
  /// Returns the vectors of an optional attribute of a primitive with this number of vertices,
  /// which may be infinite or NaN. Returns an empty list for accessor -1 and, with a warning, for
  /// an accessor that cannot be read.
  [[nodiscard]] std::vector<double> optional_vectors(int accessor, int width, const char* what,
                                                     std::size_t vertices,
                                                     std::vector<std::string>& warnings) const;
  /// Returns the numbers of an accessor of indices.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor) const;
  /// Returns the bytes of an image file, or an empty string if it is missing. Decodes data URIs of
  /// types that tinygltf does not know. Throws InputError for an image beyond its buffer.
  [[nodiscard]] std::string picture_bytes(int image) const;
  /// Returns the number of elements of an accessor.
  [[nodiscard]] std::size_t count(int accessor) const;

  /// Returns the transforms of a node's mesh to the node's coordinates: those of
  /// EXT_mesh_gpu_instancing or, without it, the identity alone.
  [[nodiscard]] std::vector<glm::dmat4> instance_transforms(const tinygltf::Node& node) const;

 private:
  struct Component;
  struct Elements;
  [[nodiscard]] Elements elements(int accessor, const char* what) const;
  /// Returns the bytes of a buffer view. Throws InputError, which names `place`, if it has none or
  /// is not within its buffer.
  [[nodiscard]] std::string_view stored(int buffer_view, const std::string& place) const;
  /// Locates elements of this type and count. Throws InputError if they exceed their buffer view.
  void find_stored(int buffer_view, std::size_t offset, const std::string& number,
                   Elements& elements) const;
  [[nodiscard]] std::vector<double> numbers(int accessor, int width, const char* what) const;
  [[noreturn]] void fail_extension(const std::string& extension) const;
  [[noreturn]] void fail_index(const char* what, int index, std::size_t count) const;

  std::string name_;
  std::vector<std::filesystem::path> files_;
  std::size_t bytes_ = 0;
  std::vector<std::string> warnings_;
  tinygltf::Model model_;
};

/// Returns the transform from a node's coordinates to its parent's.
[[nodiscard]] glm::dmat4 local_matrix(const tinygltf::Node& node);

}  // namespace raygate
