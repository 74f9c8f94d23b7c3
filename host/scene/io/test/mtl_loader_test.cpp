// Materials: every field, the defaults, odd MTL files, and refused files.
#include <gtest/gtest.h>

#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

const std::string kPicture = test::tga(1, 1, {{1, 2, 3}});
constexpr std::string_view kObjTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class LoadMtl : public testing::Test {
 protected:
  // Returns a scene of one triangle that uses material `a` of `mtl`.
  Scene load(std::string_view mtl) {
    folder_.write("m.mtl", mtl);
    return load_obj_text("mtllib m.mtl\nusemtl a\nf 1 2 3\n");
  }
  Scene load_obj_text(std::string_view more) {
    return load_obj(folder_.write("s.obj", std::string(kObjTriangle) + std::string(more)));
  }
  Material material(std::string_view mtl) {
    const Scene scene = load(mtl);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    return scene.materials.at(scene.triangles.at(0).material);
  }
  // Returns the only warning about `mtl`, without "FOLDER/".
  std::string warning(std::string_view mtl) {
    const Scene scene = load(mtl);
    if (scene.warnings.size() != 1) return std::to_string(scene.warnings.size()) + " warnings";
    return scene.warnings[0].substr(folder_.path().string().size() + 1);
  }
  std::string error(std::string_view mtl) {
    return folder_.error_of([&] { (void)load(mtl); });
  }

  const TempFolder folder_;
};

TEST_F(LoadMtl, EveryField) {
  folder_.write("wood grain.png", kPicture);
  const Material m = material(
      "newmtl a\nKa 1 1 1\nKd 0.1 0.2 0.3\nKs .4 .5 .6\nKe 7 8 9\nTf 0.7 0.8 0.9\nNs 96.5\nNi "
      "1.45\n"
      "d 0.25\nillum 7\nmap_Kd wood grain.png\n");
  EXPECT_EQ(m.name, "a");
  EXPECT_EQ(m.diffuse, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.specular, glm::vec3(0.4f, 0.5f, 0.6f));
  EXPECT_EQ(m.emission, glm::vec3(7, 8, 9));
  EXPECT_EQ(m.transmittance, glm::vec3(0.7f, 0.8f, 0.9f));
  EXPECT_EQ(m.shininess, 96.5f);
  EXPECT_EQ(m.refraction_index, 1.45f);
  EXPECT_EQ(m.opacity, 0.25f);
  EXPECT_EQ(m.illumination_model, 7);
  EXPECT_EQ(m.diffuse_map.file, (folder_.path() / "wood grain.png").string());
}

TEST_F(LoadMtl, WhatIsNotSaidIsAsInMaterial) {
  const Material m = material("newmtl a\n"), defaults;
  EXPECT_EQ(m.diffuse, defaults.diffuse);
  EXPECT_EQ(m.specular, defaults.specular);
  EXPECT_EQ(m.transmittance, defaults.transmittance);
  EXPECT_EQ(m.refraction_index, defaults.refraction_index);
  EXPECT_EQ(m.opacity, defaults.opacity);
  EXPECT_EQ(m.illumination_model, defaults.illumination_model);
  EXPECT_EQ(m.diffuse_map.file, "");
}

TEST_F(LoadMtl, OneNumberStandsForThree) {
  EXPECT_EQ(material("newmtl a\nKd 0.5 # grey\n").diffuse, glm::vec3(0.5f));
}

TEST_F(LoadMtl, TransparencyIsTheOppositeOfOpacity) {
  EXPECT_EQ(material("newmtl a\nTr 0.75\n").opacity, 0.25f);
  EXPECT_EQ(material("newmtl a\nTr 0.9\nd 0.5\n").opacity, 0.5f);
  EXPECT_EQ(material("newmtl a\nd 0.5\nTr 0.9\n").opacity, 0.5f);
}

TEST_F(LoadMtl, TrOneDoesNotHideAMaterial) {
  EXPECT_EQ(load("newmtl a\nTr 1\n").materials.at(0).opacity, 1.0f);
  EXPECT_EQ(material("newmtl a\nd 0.5\nTr 1\n").opacity, 0.5f);
  EXPECT_EQ(material("newmtl a\nTr 1\nillum 4\n").opacity, 0.0f) << "clear glass";
}

TEST_F(LoadMtl, WithoutShineThereIsNoHighlight) {
  EXPECT_EQ(material("newmtl a\nKs 1 1 1\nillum 2\nNs 0.0\n").specular, glm::vec3(0.0f));
  EXPECT_EQ(material("newmtl a\nKs 1 1 1\nillum 3\nNs 0\n").specular, glm::vec3(1.0f))
      << "a mirror";
  EXPECT_EQ(material("newmtl a\nKs 1 1 1\nillum 2\n").specular, glm::vec3(1.0f));
}

TEST_F(LoadMtl, ATextureWithoutKdStandsAsItIs) {
  folder_.write("t.png", kPicture);
  EXPECT_EQ(material("newmtl a\nmap_Kd t.png\n").diffuse, glm::vec3(1));
  EXPECT_EQ(material("newmtl a\nmap_Kd t.png\nKd 0.5 0.5 0.5\n").diffuse, glm::vec3(0.5f));
  EXPECT_EQ(material("newmtl a\nKd 0.5 0.5 0.5\nmap_Kd t.png\n").diffuse, glm::vec3(0.5f));
}

TEST_F(LoadMtl, TextureOptionsAreNotTheFile) {
  folder_.write("3d model.png", kPicture);
  folder_.write("-minus.png", kPicture);
  for (const char* options : {"-t 1 2 3", "-clamp on -bm 2 -mm 0 1", "-imfchan r"}) {
    const Scene scene = load(std::string("newmtl a\nmap_Kd ") + options + " 3d model.png\n");
    EXPECT_EQ(scene.materials[0].diffuse_map.file, (folder_.path() / "3d model.png").string());
    EXPECT_EQ(scene.warnings.size(), 1u);
  }
  const Material m = material("newmtl a\nmap_Kd -s 2 -clamp on -o 0.5 0.25 3d model.png\n");
  EXPECT_EQ(m.diffuse_map.file, (folder_.path() / "3d model.png").string());
  EXPECT_EQ(m.diffuse_map.mapping.scale, glm::vec2(2, 1));
  EXPECT_EQ(m.diffuse_map.mapping.offset, glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(m.diffuse_map.mapping.sampling.u, Wrap::kClamp);
  EXPECT_EQ(material("newmtl a\nmap_Kd -minus.png\n").diffuse_map.file,
            (folder_.path() / "-minus.png").string());
}

TEST_F(LoadMtl, ThePbrStatementsMakeAMaterialMetallicAndRough) {
  EXPECT_FALSE(material("newmtl a\nKd 1 0 0\nNs 250\n").metallic_roughness);
  const Material m = material("newmtl a\nPr 0.25\nPm 0.75\nd 0.5\n");
  ASSERT_TRUE(m.metallic_roughness);
  EXPECT_EQ(m.metallic_roughness->roughness, 0.25f);
  EXPECT_EQ(m.metallic_roughness->metallic, 0.75f);
  EXPECT_EQ(m.metallic_roughness->transmission, 0.0f);
  EXPECT_EQ(m.opacity, 0.5f);
  EXPECT_EQ(material("newmtl a\nPm 1\nNs 250\n").metallic_roughness->roughness, 0.5f)
      << "as Ns has it";
  EXPECT_EQ(material("newmtl a\nPr 0\nnewmtl b\nPm 1\n").metallic_roughness->metallic, 0.0f);
  EXPECT_EQ(material("newmtl a\nillum 7\nd 0\nPr 0.5\n").metallic_roughness->transmission, 1.0f);
}

TEST_F(LoadMtl, MapsOfRoughnessMetalnessOpacityAndNormals) {
  using test::tga;
  folder_.write("rough.tga", tga(1, 1, {{51, 51, 51}}));
  folder_.write("metal.tga", tga(2, 1, {{102, 102, 102}, {204, 204, 204}}));
  folder_.write("hole.tga", tga(2, 1, {{0, 0, 0}, {255, 255, 255}}));
  folder_.write("whole.tga", tga(1, 1, {{200, 200, 200}}));
  const Scene scene = load(
      "newmtl a\nmap_Pr rough.tga\nmap_Pm -s 2 metal.tga\nmap_d hole.tga\nnorm -bm 0.5 "
      "rough.tga\nmap_Ke metal.tga\n");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(1.0f)) << "as the texture has it";
  EXPECT_EQ(scene.textures.at(scene.materials[0].emission_map.texture).texels().at(1)[0], 204);
  const Material& m = scene.materials[scene.triangles[0].material];
  ASSERT_TRUE(m.metallic_roughness);
  EXPECT_EQ(m.metallic_roughness->roughness, 1.0f);
  EXPECT_EQ(m.metallic_roughness->metallic, 1.0f);
  EXPECT_EQ(m.metallic_roughness->metallic_map.mapping.scale, glm::vec2(2, 1));
  EXPECT_EQ(scene.textures.at(m.metallic_roughness->roughness_map.texture).texels().at(0)[1], 51);
  EXPECT_EQ(scene.textures.at(m.metallic_roughness->metallic_map.texture).texels().at(1)[2], 204);
  EXPECT_EQ(m.normal_scale, 0.5f);
  EXPECT_NE(m.normal_map.texture, kNoIndex);
  ASSERT_NE(m.opacity_map.texture, kNoIndex);
  EXPECT_EQ(scene.textures[m.opacity_map.texture].min_code(), 0.0);
  EXPECT_EQ(material("newmtl a\nmap_d whole.tga\n").opacity_map.texture, kNoIndex)
      << "it hides nothing";
}

TEST_F(LoadMtl, OddTextIsFine) {
  EXPECT_EQ(material("\xEF\xBB\xBFnewmtl  a \r\n\tKd 0.5 \\\r\n 0.25 0.125\r\n").diffuse,
            glm::vec3(0.5f, 0.25f, 0.125f));
}

TEST_F(LoadMtl, NamesMayHoldSpaces) {
  folder_.write("my colours.mtl", "newmtl deep red\nKd 1 0 0\nnewmtl deep\nKd 0 1 0\n");
  const Scene scene = load_obj_text("mtllib my colours.mtl\nusemtl deep red\nf 1 2 3\n");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.materials[scene.triangles[0].material].diffuse, glm::vec3(1, 0, 0));
}

TEST_F(LoadMtl, SeveralFilesAndFolders) {
  folder_.write("1.mtl", "newmtl a\nKd 1 0 0\n");
  folder_.write("sub/t.png", kPicture);
  folder_.write("sub/2.mtl", "newmtl b\nKd 0 1 0\nmap_Kd t.png\n");
  folder_.write("3.mtl", "newmtl c\nKd 0 0 1\n");
  const Scene scene = load_obj_text(
      "mtllib 1.mtl sub\\2.mtl\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl\nf 1 2 3\nmtllib "
      "1.mtl\n"
      "mtllib 3.mtl\n");
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.materials.size(), 4u);
  EXPECT_EQ(scene.materials[scene.triangles[0].material].name, "b");
  EXPECT_EQ(scene.materials[1].diffuse_map.file, (folder_.path() / "sub" / "t.png").string());
  EXPECT_EQ(scene.materials[scene.triangles[1].material].name, "c") << "mtllib after usemtl";
  EXPECT_EQ(scene.materials[scene.triangles[2].material].name, "default") << "usemtl without name";
}

TEST_F(LoadMtl, MissingFilesAndMaterialsAreWarnedOf) {
  const Scene scene = load_obj_text("mtllib none.mtl\nusemtl x\nf 1 2 3\nusemtl x\nf 1 2 3\n");
  const std::string file = (folder_.path() / "s.obj").string();
  EXPECT_EQ(scene.warnings,
            (std::vector<std::string>{
                file + ":4: material file 'none.mtl' is missing, default materials instead",
                file + ":5: material 'x' is defined nowhere, the default instead"}));
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].diffuse, Material().diffuse);
  EXPECT_EQ(scene.triangles[1].material, 0u);
}

TEST_F(LoadMtl, Warnings) {
  const std::pair<const char*, const char*> warnings[] = {
      {"d 1.5", "m.mtl:2: d '1.5' is out of range, taken as 1"},
      {"Ni 0", "m.mtl:2: Ni '0' is out of range, taken as 1"},
      {"illum 99", "m.mtl:2: illum '99' is out of range, taken as 10"},
      {"Pr 2", "m.mtl:2: Pr '2' is out of range, taken as 1"},
      {"Tr 1\nillum 2", "m.mtl:2: found Tr 1, which hides the material, expected less; taken as 0"},
      {"Kd -1 0 0", "m.mtl:2: Kd '-1' is negative, taken as 0"},
      {"map_Bump b.png\nmap_Bump c.png", "m.mtl:2: 'map_Bump' is not supported, ignored"},
      {"Kd spectral red.rfl", "m.mtl:2: Kd spectral is not supported, ignored"},
      {"d -halo 0.5", "m.mtl:2: d -halo is not supported, taken as d"},
      {"map_Kd none.png", "none.png: the texture is missing, its material is plain instead"},
      {"map_Pr", "m.mtl:2: map_Pr without a file, ignored"},
      {"map_Kd", "m.mtl:2: map_Kd without a file, ignored"},
      {"newmtl b\nnewmtl a\nKd 0 1 0", "m.mtl:3: material 'a' was defined before, which stands"},
      {"newmtl \nKd 0 1 0",
       "m.mtl:2: newmtl without a name: nothing can use this material, ignored"}};
  for (const auto& [text, expected] : warnings) {
    EXPECT_EQ(warning("newmtl a\n" + std::string(text) + "\n"), expected);
  }
}

TEST_F(LoadMtl, TheFirstOfTwoMaterialsOfOneNameStands) {
  const Scene scene = load("newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\n");
  EXPECT_EQ(scene.materials[scene.triangles[0].material].diffuse, glm::vec3(1, 0, 0));
}

// Blender writes newmtl without a name for objects without a material.
TEST_F(LoadMtl, AMaterialWithoutAName) {
  const Scene scene = load("newmtl \nKd 0 1 0\nnewmtl a\nKd 1 0 0\nnewmtl\nKd 0 0 1\n");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].diffuse, glm::vec3(1, 0, 0));
}

TEST_F(LoadMtl, AFileWithoutMaterials) {
  const Scene scene = load("# nothing\n");
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_TRUE(scene.warnings[0].ends_with("m.mtl: defines no material"));
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
}

TEST_F(LoadMtl, Errors) {
  const std::pair<std::string, std::string> errors[] = {
      {"newmtl a\nKd 1 0\n",
       "m.mtl:2: Kd with 2 numbers, expected red, green and blue, or one for all three"},
      {"newmtl a\nKd 1 0 0 1\n", "m.mtl:2: Kd with more than 3 numbers"},
      {"newmtl a\nillum 1.5\n",
       "m.mtl:2: illum: found '1.5', expected a whole number from 0 to 10"},
      {"newmtl a\nd 0.5 0.5\n", "m.mtl:2: d: found several numbers, expected one"},
      {"Kd 1 0 0\n", "m.mtl:1: 'Kd' before the first newmtl"},
      {"", "m.mtl: the file is empty"},
      {std::string("newmtl a\n\0", 10), "m.mtl:2: a byte of value 0: not a text file"}};
  for (const auto& [text, expected] : errors) EXPECT_EQ(error(text), expected);
  const std::pair<const char*, const char*> no_numbers[] = {
      {"Kd 1 zero 0", "Kd: found 'zero'"},
      {"Ke nan 0 0", "Ke: found 'nan'"},
      {"Ns inf", "Ns: found 'inf'"},
      {"d", "d: found the end"},
      {"map_Kd -s wide t.png", "map_Kd -s: found 'wide'"},
      {"map_Kd -o", "map_Kd -o: found the end"}};
  for (const auto& [text, found] : no_numbers) {
    EXPECT_EQ(error("newmtl a\n" + std::string(text) + "\n"),
              "m.mtl:2: " + std::string(found) + ", expected a number within the range of float");
  }
}

}  // namespace
}  // namespace raygate
