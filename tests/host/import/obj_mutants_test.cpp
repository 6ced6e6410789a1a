// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL texts with lines and characters changed at random: each gives a valid scene or one error.
#include <random>

#include "host/import/obj_files.h"

using namespace sunstone;
using namespace sunstone::test;

TEST(ObjMutants, GiveAValidSceneOrAnError) {
  const std::string obj =
      "mtllib m.mtl\no thing\nv -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0.5 0 0 1\nv -1 1 0\nv 0 0.25 1e-3\nvt 0 0\nvt 1 0\nvt 1 1 0\nvn 0 0 1\nvn 0 1 "
      "0\ng a b\ns 1\n"
      "usemtl red\nf 1/1/1 2/2/1 3/3/2 4/1/2\ns off\nusemtl glass\nf -5//1 -4//1 -1//2\nf 1 5 2 3 \\\n 4\ns 7\nf 1/2 2/3 5/1\nl 1 2\np 1\nt crease "
      "2/1/0 0 1 2.0\n";
  const std::string mtl =
      "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 100\nd 0.5\nillum 2\nmap_Kd -o 0.1 0.2 -clamp on none.png\nnewmtl glass\nNi 1.5\nTf 1 1 1\nillum "
      "7\nPr 0.5\nbump -bm 3 b.png\n"
      "Ke 1 2 3\nTr 0.1\nmap_d a.png -imfchan r\n";
  const char alphabet[] = "0123456789-+./ \n\r\t\\#eEvfnts\0\xff\x80";
  std::mt19937 random(7);
  const auto mutate = [&](std::string text) {
    for (int k = 1 + static_cast<int>(random() % 6); k > 0 && !text.empty(); k--) {
      const std::size_t at = random() % text.size();
      switch (random() % 6) {
        case 0:
          text[at] = alphabet[random() % (sizeof alphabet - 1)];
          break;
        case 1:
          text.erase(at, 1 + random() % 5);
          break;
        case 2:
          text.insert(at, 1, alphabet[random() % (sizeof alphabet - 1)]);
          break;
        case 3:
          text.insert(at, text.substr(random() % text.size(), 1 + random() % 40));
          break;
        case 4:
          text.insert(at, random() % 2 ? " 99999999999999999999 " : " -2147483648/1e400/nan ");
          break;
        case 5:
          text.resize(at);
          break;
      }
    }
    return text;
  };
  const Folder folder;
  int scenes = 0, refused = 0;
  for (int i = 0; i < 1500; i++) {
    folder.write("m.mtl", i % 3 ? mutate(mtl) : mtl);
    const Imported in = import_file(folder.write("s.obj", i % 3 != 1 ? mutate(obj) : obj));
    if (!in.error.empty()) {
      refused++;
      continue;
    }
    scenes++;
    for (const Mesh &mesh : in.scene.meshes)
      for (const Primitive &p : mesh.primitives) {
        ASSERT_EQ(p.indices.size() % 3, 0u);
        for (const std::uint32_t index : p.indices) ASSERT_LT(index, p.positions.size());
        ASSERT_LT(p.material, static_cast<int>(in.scene.materials.size()));
      }
    ASSERT_LT(in.notices.size(), 60u);
  }
  EXPECT_GT(scenes, 1000);
  EXPECT_LT(refused, 300);
}
