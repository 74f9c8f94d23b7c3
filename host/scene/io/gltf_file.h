// A glTF 2.0 file as tinygltf parses it, and the numbers of its accessors, each checked.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {

/// .gltf or .glb, with its buffers and the bytes of its pictures. (tinygltf because Debian 12 has
/// it, under the MIT licence, in one header that the sanitizers can see through; it parses, and
/// leaves all that indices and lengths say unchecked, which is done here.)
class GltfFile {
 public:
  /// Throws InputError: what cannot be read, is no glTF 2.0, or needs an extension that is not
  /// known.
  explicit GltfFile(const std::filesystem::path& file);

  [[nodiscard]] const tinygltf::Model& model() const { return model_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// All that were read.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Warnings about them.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  /// Of all of them together.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  [[noreturn]] void fail(const std::string& what) const;
  /// Appends "file: what" to warnings that do not have it yet.
  void warn_once(const std::string& what, std::vector<std::string>& warnings) const;

  /// Appends an error about something optional, and what is done about it, likewise.
  static void warn_once(const InputError& error, const char* instead,
                        std::vector<std::string>& warnings);

  /// The element of `list` with this number; `what` is for messages.
  template <class T>
  [[nodiscard]] const T& at(const std::vector<T>& list, int index, const char* what) const {
    if (index >= 0 && static_cast<std::size_t>(index) < list.size()) {
      return list[static_cast<std::size_t>(index)];
    }
    fail_index(what, index, list.size());
  }

  /// Returns `width` finite numbers of each element of an accessor: of the vector's first
  /// components. Throws InputError where there are none such.
  [[nodiscard]] std::vector<double> vectors(int accessor, int width, const char* what) const;
  /// Returns the same of an attribute that a primitive of `vertices` can do without, NaN for what
  /// is not finite. Empty for accessor -1 and, with a warning, for one that cannot be read.
  [[nodiscard]] std::vector<double> optional_vectors(int accessor, int width, const char* what,
                                                     std::size_t vertices,
                                                     std::vector<std::string>& warnings) const;
  /// The whole numbers of an accessor of indices.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor) const;
  /// Returns a picture's file; empty where it is missing. The library decodes data URIs of a few
  /// types alone.
  [[nodiscard]] static std::string picture_bytes(const tinygltf::Image& image);
  /// How many elements an accessor has.
  [[nodiscard]] std::size_t count(int accessor) const;

  /// Where a node has its mesh, in its own coordinates: once, or as EXT_mesh_gpu_instancing says.
  [[nodiscard]] std::vector<glm::dmat4> instance_transforms(const tinygltf::Node& node) const;

 private:
  struct Component;
  struct Elements;
  [[nodiscard]] Elements elements(int accessor, const char* what) const;
  /// Sets where elements of that type and count are stored; fails where their buffer ends too soon.
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

/// From a node's coordinates to its parent's.
[[nodiscard]] glm::dmat4 local_matrix(const tinygltf::Node& node);

}  // namespace raygate
