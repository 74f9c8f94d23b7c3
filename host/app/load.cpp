#include "host/app/load.h"

#include <filesystem>
#include <string>

#include "host/base/input_error.h"
#include "host/film/environment_file.h"
#include "host/scene/instances.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

/// Throws InputError if the model of a scene file is missing, and names the script that makes it.
void require_model(const SceneFile& file) {
  std::error_code ignored;
  if (file.obj == file.file || std::filesystem::exists(file.obj, ignored)) return;
  const std::string model = file.obj.lexically_normal().string();
  const std::filesystem::path script =
      file.file.parent_path() / ("make_" + file.file.stem().string() + ".py");
  throw InputError(file.file.string() + ": found no " + model +
                   ", expected the scene that it is about" +
                   (std::filesystem::exists(script, ignored)
                        ? "; `make verilate` makes it, and so does `python3 " + script.string() +
                              " " + model + "`"
                        : ""));
}

}  // namespace

Scene load(const SceneFile& file, const LoadOptions& options,
           const std::optional<EnvironmentSetting>& environment,
           const std::optional<glm::dvec3>& up) {
  require_model(file);
  Scene scene = load_scene(file, options);
  require_numbers(scene, file.file);
  if (!environment) return scene;
  const std::optional<glm::dvec3>& known = up ? up : file.up;
  load_environment(*environment, known ? *known : usual_up_axis(scene), scene);
  return scene;
}

}  // namespace raygate
