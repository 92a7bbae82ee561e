// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scenes of oriented boxes from a CSV file. No ROS in here.
///
/// Its header line names the columns, in any order:
///   scene,stamp,frame_id,id,class,cx,cy,cz,qx,qy,qz,qw,sx,sy,sz
/// One line is one box: center [m] and orientation (any non-zero quaternion) in frame_id, full
/// sides [m] along the box's own axes. Boxes with one scene and one stamp belong together.
#pragma once

#include <box_query/geometry.h>

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

namespace box_query {

struct CsvBox {
  std::string frame_id;
  std::string id;
  std::string box_class;
  Vector3 center;          ///< [m] in frame_id
  Quaternion orientation;  ///< from the box's axes to frame_id, as it stands in the file
  Vector3 size;            ///< [m] full sides, >= 0
  std::size_t line = 0;    ///< of the file, from 1
};

/// The boxes of one (scene, stamp) pair, in the order of the file. No two have one class and one
/// id.
struct CsvScene {
  std::string scene;
  double stamp = 0.0;  ///< [s], or a plain number of the frame
  std::vector<CsvBox> boxes;
};

/// Scenes in the order in which the file names them first.
///
/// Decimal point and digits are read as in the C locale. Blank lines are skipped, CRLF is a line
/// end, a field may be quoted ("" is a quote in it) but not continue on the next line.
/// @throws std::runtime_error with `name`, line, column and what is wrong: a missing, unknown or
/// repeated column, a wrong number of fields, an open quote, a number that is none or not finite, a
/// negative size, a zero quaternion, an empty frame, a box that is there twice.
std::vector<CsvScene> readBoxCsv(std::istream& in, const std::string& name);

/// @throws std::runtime_error also if the file cannot be read.
std::vector<CsvScene> readBoxCsvFile(const std::string& path);

}  // namespace box_query
