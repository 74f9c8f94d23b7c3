// The pictures that materials name, from files into a scene.
#pragma once

#include "host/scene/scene.h"

namespace raygate {

/// Loads the textures that materials of triangles name by files, each file once for each use;
/// fills Scene::textures and the materials' indices. Pictures of roughness and of metalness
/// become one. Masks that hide nothing are left out. Warns of a file that is missing; throws
/// InputError as Texture::load.
void load_textures(Scene& scene);

}  // namespace raygate
