// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL -> Scene. The text is surveyed and guarded (obj_guard.h, obj_mtl_guard.cpp), read by tinyobjloader (obj_loader.h), and made into one
// mesh of a primitive a material (obj_mesh.h) with materials after docs/obj-materials.md.
#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "import/importers.h"
#include "import/obj_loader.h"
#include "import/obj_textures.h"

namespace sunstone {

Scene import_obj(const std::filesystem::path &path, const ImportOptions &options, Notices &notices) {
  const std::string file = printable(path.string(), 400);
  const std::vector<std::byte> data = read_file(path);
  const std::string_view text = checked_text({reinterpret_cast<const char *>(data.data()), data.size()}, file);
  Scene scene;
  scene.name = path.stem().string();

  const ObjSurvey survey = survey_obj(text);
  if (survey.positions == 0 && survey.faces == 0) throw Error(file, "there is no geometry in it");
  if (survey.positions > 0x7fffffff / 3 || survey.normals > 0x7fffffff / 3 || survey.texture_coordinates > 0x7fffffff / 3)
    throw Error(file, "has more vertices than the 715 million that are read");
  const GuardedMtl libraries = read_libraries(survey, path, options, notices);
  LineFaults faults(file);
  const GuardedObj guarded = guard_obj(text, survey, libraries.numbers, faults);
  faults.report(notices);
  if (guarded.corners.empty()) {
    notices.warning(file, survey.faces ? "there is nothing to render: no face is left" : "there is nothing to render: it has no faces");
    return scene;
  }

  LoadedObj obj = load_obj(guarded, libraries, file);
  std::vector<bool> used(libraries.names.size());
  bool uses_default = false;
  for (int &material : obj.faces.materials) {
    if (material >= 0)
      used[material] = true;
    else
      uses_default = true;
  }
  ObjTextures textures(path, options, scene, notices);
  scene.materials = make_obj_materials(libraries, obj, used, textures, file);
  if (uses_default) {
    const int number = static_cast<int>(scene.materials.size());
    std::replace_if(
        obj.faces.materials.begin(), obj.faces.materials.end(), [](int material) { return material < 0; }, number);
    scene.materials.push_back(default_obj_material());
  }
  ObjMesh built = build_obj_mesh(obj.faces);
  if (built.crossing)
    notices.warning(file,
                    std::to_string(built.crossing) +
                        (built.crossing == 1 ? " polygon crosses itself or is too intricate" : " polygons cross themselves or are too intricate") +
                        ": what is rendered of it may overlap");
  built.mesh.name = scene.name;
  scene.meshes.push_back(std::move(built.mesh));
  scene.instances.push_back({scene.name, 0, glm::mat4x3(1)});
  return scene;
}

}  // namespace sunstone
