// SPDX-License-Identifier: BSD-3-Clause
// Any file: it is read, or refused with a sentence that names it.
#include "fuzz/fuzz.h"
#include "ros/box_csv.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace box_query::fuzz {

std::vector<Bytes> seeds() {
  const std::string header = "scene,stamp,frame_id,id,class,cx,cy,cz,qx,qy,qz,qw,sx,sy,sz\n";
  std::vector<Bytes> all;
  for (const std::string& text :
       {header + "a,0,map,1,rack,1,2,3,0,0,0,1,0.5,0.5,2\na,0,map,2,rack,1e3,-2,.5,0,0,1,0,1,0,1\n",
        header + "\"a, b\",1.5,map,\"say \"\"x\"\"\",,1,2,3,0.5,0.5,0.5,0.5,1,1,1\r\n\r\n",
        std::string("id,class,scene,stamp,frame_id,sx,sy,sz,cx,cy,cz,qx,qy,qz,qw\n"
                    "1,c,s,0,map,1,1,1,0x1p3,nan,inf,0,0,0,0\n"),
        header}) {
    all.emplace_back(text.begin(), text.end());
  }
  return all;
}

void testOne(const std::uint8_t* data, std::size_t size) {
  std::istringstream file(std::string(data, data + size));
  std::vector<CsvScene> scenes;
  try {
    scenes = readBoxCsv(file, "fuzz.csv");
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find("fuzz.csv") != std::string::npos,
            "a file that is refused is named");
    return;
  }
  for (const CsvScene& scene : scenes) {
    require(!scene.boxes.empty(), "a scene has boxes");
    for (const CsvBox& box : scene.boxes) {
      require(box.center.allFinite() && box.size.allFinite() && box.size.minCoeff() >= 0.0 &&
                  box.orientation.coeffs().allFinite() && !box.orientation.coeffs().isZero(0) &&
                  !box.frame_id.empty(),
              "a box that is read can be published");
    }
  }
}

}  // namespace box_query::fuzz
