#include <vector>

#include "host/scene/io/load_textures.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/obj_reader.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

/// Names become materials at the end of the file, so that mtllib may come after usemtl.
void give_materials(const ObjReader& obj, Scene& scene) {
  scene.materials = obj.mtl().materials();
  std::uint32_t default_material = kNoIndex;
  std::vector<std::uint32_t> materials;
  const std::vector<std::string>& names = obj.materials();
  for (std::size_t i = 0; i < names.size(); ++i) {
    materials.push_back(obj.mtl().find(names[i]).value_or(kNoIndex));
    if (materials[i] == kNoIndex && !names[i].empty()) {
      scene.warnings.push_back(obj.material_places()[i] + "material " + in_quotes(names[i]) +
                               " is defined nowhere, the default instead");
    }
  }
  for (Triangle& triangle : scene.triangles) {
    if (triangle.material != kNoIndex) triangle.material = materials[triangle.material];
    if (triangle.material != kNoIndex) continue;
    if (default_material == kNoIndex) {
      default_material = static_cast<std::uint32_t>(scene.materials.size());
      scene.materials.emplace_back().name = "default";
    }
    triangle.material = default_material;
  }
}

}  // namespace

Scene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
  Scene scene;
  MeshBuilder mesh(file.string());
  ObjReader obj(file, mesh, scene.warnings);
  obj.read(options);
  mesh.build(options, scene);
  scene.objects = obj.objects();
  scene.files = {obj.mtl().files().begin(), obj.mtl().files().end()};
  scene.files.push_back(file);
  give_materials(obj, scene);
  if (options.textures) load_textures(scene);
  return scene;
}

}  // namespace raygate
