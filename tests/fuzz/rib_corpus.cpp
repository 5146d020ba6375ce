// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/corpus.h"

namespace pelage {

std::vector<std::string> rib_corpus() {
  const std::string text =
      "##RenderMan RIB\nOption \"pelage\" \"string image\" [\"{width: 20}\"]\nFrameBegin 1\nFormat 32 24 "
      "1\nShutter 0 0.5\n"
      "Projection \"perspective\" \"fov\" [35]\nDepthOfField 4 0.5 6\nTranslate 0 0 5\nScale 1 1 "
      "-1\nWorldBegin\n"
      "LightSource \"distantlight\" 1 \"intensity\" 2\nAttributeBegin AreaLightSource \"a\" 2 Sphere 1 -1 1 "
      "360 AttributeEnd\n"
      "ObjectBegin 1\nCurves \"linear\" [2 3] \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 0 0 1 0 0 2 1 0] "
      "\"constantwidth\" 0.1\nObjectEnd\n"
      "Surface \"plastic\" Attribute \"identifier\" \"name\" \"b\" ObjectInstance 1\n"
      "MotionBegin [0 0.5] Translate 0 0 0 Rotate 5 0 1 0 MotionEnd\n"
      "Basis \"bezier\" 3 \"catmull-rom\" 1\nCurves \"cubic\" [6] \"periodic\" \"P\" [0 0 0 1 0 0 2 1 0 2 2 "
      "1 1 3 1 0 2 0] "
      "\"vertex float width\" [1 2 3 4 5 6] \"uniform color Cs\" [1 0 0] \"uniform integer id\" [5]\n"
      "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"crease\" \"hole\"] [2 1 1 0] [0 1 0] [2.5] \"P\" "
      "[0 0 0 1 0 0 1 1 0 0 1 0] "
      "\"facevarying float[2] st\" [0 0 1 0 1 1 0 1]\nWorldEnd\nFrameEnd\n";
  // An array of 27 floats: 1, 0.5 and 0.25, in an order without repeated points.
  std::string points = "\xc8\x1b";
  for (int i = 0; i < 27; ++i)
    points += std::string(i % 4 == 0 ? "\x3f\x80"
                          : i % 5    ? "\x3f\x00"
                                     : "\x3e\x80",
                          2) +
              std::string(2, '\0');
  const std::string binary =
      "\xcc\x01\x96"
      "Curves\xcc\x02\x95"
      "Basis\xcd\x01\x91P\xcd\x02\x93"
      "id!\xa6\x02\x98"
      "b-spline\x80\x01\x98"
      "b-spline\x80\x01"
      "\xa6\x01\x95"
      "cubic[\x80\x04\x80\x05]\x9b"
      "nonperiodic\xcf\x01" +
      points +
      "\x9d"
      "constantwidth\xa4\x3f" +
      std::string(3, '\0');
  std::vector<std::string> corpus{text, binary};
  // Claims, nesting, and files that read themselves or themselves again and again.
  corpus.push_back("Curves \"linear\" [1000000000 1000000000 1000000000] \"nonperiodic\" \"P\" [0]");
  corpus.push_back("Curves \"linear\" [2147483647] \"periodic\" \"P\" [0]");
  corpus.push_back("Curves \"cubic\" \xcb\x3b\x9a\xc9\xff");
  corpus.push_back("\xa3\xff\xff\xff\xff");
  corpus.push_back("PointsPolygons [1000000] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]");
  corpus.push_back(
      "SubdivisionMesh \"loop\" [3] [0 1 2] [\"crease\"] [2147483647 2147483647] [0] [0] \"P\" [0 0 0 1 0 0 "
      "0 1 0]");
  std::string deep, codes,
      motion = "MotionBegin [",
      objects = "ObjectBegin 1 Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 1 1] ObjectEnd ";
  for (int i = 0; i < 5000; ++i) {
    deep += "AttributeBegin ";
    codes += "\xcc\x01";
    motion += std::to_string(i) + " ";
    objects += "ObjectInstance 1 ";
  }
  for (const std::string& end :
       {deep, codes, motion + "]", objects, std::string(20000, '['), std::string(20000, '"')})
    corpus.push_back(end);
  corpus.push_back(
      "Translate 1e38 1e38 1e38 Scale 1e30 1e30 1e30 Curves \"linear\" [2] \"nonperiodic\" \"P\" [1e38 1 1 0 "
      "0 0]");
  corpus.push_back(
      "Option \"pelage\" \"string image\" [\"{a: [\"] Projection \"perspective\" WorldBegin WorldEnd");
  return corpus;
}

}  // namespace pelage
